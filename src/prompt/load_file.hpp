// Loads a file of Lua by its name, for those who start scripts: main's argument, :load, the init file.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// luaL_loadfile, which takes its time and memory like any other code. In safe mode no bytecode, and only files that a
/// script may read.
int load_file(lua_State* L, const char* file);

}  // namespace dinal::prompt
