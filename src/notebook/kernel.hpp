// The prompt for a program that is not a terminal: requests and answers as lines of JSON. docs/notebook.md describes
// them.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "text/expected.hpp"

namespace dinal::notebook {

/// Serves the requests on standard input to their end and answers on the descriptor. What scripts print goes to
/// standard output and standard error as ever, and is there before the answer. False when that descriptor is not open.
bool run_kernel(lua_State* L, int answers);

/// Writes two kernels, one of them with --safe, into the user's folder of Jupyter: $JUPYTER_DATA_DIR, or jupyter in
/// $XDG_DATA_HOME, or ~/.local/share/jupyter. Each is a kernel.json with the program in Python beside it. Returns what
/// was done, in words.
text::Expected<std::string> install_kernel();

/// dinal_kernel.py, which CMake puts into the program.
extern const char* const kernel_script;

}  // namespace dinal::notebook
