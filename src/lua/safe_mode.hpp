// Safe mode: a restricted Lua for scripts of strangers. docs/safe-mode.md states its guarantees.
//
// It is a list of allowed functions: a new function of Lua is unavailable until it is listed. The limits of time and
// memory (limits.hpp) are part of it, and so is the confinement of files to the current folder (files/confinement.hpp),
// which open_safe_libraries() switches on.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Replaces luaL_openlibs, before open_library(). For the whole process, and permanent.
void open_safe_libraries(lua_State* L);

[[nodiscard]] bool safe_mode() noexcept;

/// The mode for lua_load of every chunk: "t" in safe mode, because bytecode can crash Lua, otherwise null for any.
[[nodiscard]] const char* load_mode() noexcept;

}  // namespace dinal::lua
