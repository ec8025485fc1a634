// Safe mode: what scripts of strangers see of Lua, and what they cannot reach. docs/safe-mode.md says what it
// promises.
//
// It is a list of what is there, not of what is taken away: a new function of Lua is not there until it is listed. The
// limits of time and memory (limits.hpp) belong to it, and so does keeping our own functions to the current folder
// (io/confinement.hpp), which open_safe_libraries() does.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// In the place of luaL_openlibs, before open_library(). For the whole process and for good.
void open_safe_libraries(lua_State* L);

[[nodiscard]] bool safe_mode() noexcept;

/// The mode for lua_load of every chunk: "t" in safe mode, because bytecode can crash Lua, else null for any.
[[nodiscard]] const char* load_mode() noexcept;

}  // namespace dinal::lua
