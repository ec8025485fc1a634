// Executes the command line in lua's order: LUA_INIT, -e -l -W, the script, the prompt.
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

/// Replaces the prompt for --kernel: answers on the descriptor. Returns false if it cannot.
using Kernel = bool (*)(lua_State* L, int answers);

/// Returns the exit code; errors have been printed on standard error.
int run(const Arguments& arguments, Kernel kernel);

/// Prints "dinal: text" on standard error.
void complain(const std::string& text);

/// The first line of -v and the prompt, and the output of --version.
std::string version_line();
std::string version_text();

}  // namespace dinal::prompt
