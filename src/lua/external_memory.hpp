// What Lua's garbage collector can not see: the numbers behind vectors and runs, which C++ holds.
#pragma once

#include <cstddef>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// To be called after an object was pushed that holds so many bytes outside of Lua. Collects the garbage when that has
/// added up: otherwise a loop over long vectors would fill the memory with dead ones, 40 bytes each for Lua.
void note_external_memory(lua_State* L, std::size_t bytes);

}  // namespace dinal::lua
