// Safe mode: a restricted Lua for scripts of strangers. docs/safe-mode.md states its guarantees.
//
// It is a list of allowed functions: a new function of Lua is unavailable until it is listed. The limits of time and
// memory are part of it, and so is the confinement of files to the current folder (files/file.hpp),
// which open_safe_libraries() switches on.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "lua/interrupt.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Replaces luaL_openlibs, before open_library(). For the whole process, and permanent.
void open_safe_libraries(lua_State* L);

[[nodiscard]] bool safe_mode() noexcept;

/// The mode for lua_load of every chunk: "t" in safe mode, because bytecode can crash Lua, otherwise null for any.
[[nodiscard]] const char* load_mode() noexcept;

// The limits of time and memory of a script, --max-time and --max-memory.

struct ScriptLimits {
    std::size_t memory = 0;  ///< bytes; 0: no limit
    double seconds = 0;      ///< processor time; 0: no limit
};

/// The defaults in safe mode and in marking.
inline constexpr ScriptLimits safe_limits{.memory = std::size_t{256} << 20U, .seconds = 10};

/// Sets the limits for all later chunks. Call once, before the first chunk.
void set_limits(lua_State* L, const ScriptLimits& limits);

/// "stopped at lab.lua:3: it ran longer than the 10 s that --max-time allows". `place` may be empty.
std::string limit_sentence(Stop reason, const std::string& place);

/// The sentence if a limit stopped the last chunk, otherwise empty.
std::string reached_limit();

// Output after a limit was reached, when possibly nobody reads it:

/// Writes to standard error without blocking, as far as it is read.
void write_error_in_time(std::string_view text);

/// Ends the program: completes the script's files, and writes standard output if it is read.
[[noreturn]] void exit_in_time(int code);

}  // namespace dinal::lua
