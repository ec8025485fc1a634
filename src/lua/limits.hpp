// The limits of time and memory of a script, as --max-time and --max-memory name them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "lua/interrupt.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::lua {

struct ScriptLimits {
    std::size_t memory = 0;  ///< bytes; 0: none
    double seconds = 0;      ///< of processor time; 0: none
};

/// What safe mode and marking allow where the user does not say otherwise.
inline constexpr ScriptLimits safe_limits{.memory = std::size_t{256} << 20U, .seconds = 10};

/// Puts the limits in force for all chunks that run from now on. Once, before the first of them.
void set_limits(lua_State* L, const ScriptLimits& limits);

/// "stopped at lab.lua:3: it ran longer than the 10 s that --max-time allows". `place` may be empty.
std::string limit_sentence(Stop reason, const std::string& place);

/// The sentence when a limit has stopped the last chunk, else empty.
std::string reached_limit();

// What is still said and done when a limit was reached: nobody may be there to read it.

/// Writes on standard error as much as somebody takes in time.
void write_error_in_time(std::string_view text);

/// The end of the program: the files of the script are written to their ends, standard output if somebody takes it.
[[noreturn]] void exit_in_time(int code);

}  // namespace dinal::lua
