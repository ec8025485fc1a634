// Running what the command line asks for, in lua's order: LUA_INIT, -e -l -W, the script, the prompt.
#pragma once

#include "lua/lua_headers.hpp"
#include "prompt/arguments.hpp"

namespace dinal::prompt {

namespace exit_code {
constexpr int ok = 0;
constexpr int script_error = 1;
constexpr int usage = 2;
constexpr int interrupted = 130;
}  // namespace exit_code

/// What --kernel runs in place of the prompt: it answers on the descriptor. False when it cannot.
using Kernel = bool (*)(lua_State* L, int answers);

/// Returns the exit code; what went wrong has been told on standard error.
int run(const Arguments& arguments, Kernel kernel);

/// "dinal: text" on standard error.
void complain(const std::string& text);

/// The line that -v and the prompt begin with, and what --version prints.
std::string version_line();
std::string version_text();

}  // namespace dinal::prompt
