// The prompt for other programs: requests and answers as lines of JSON. docs/notebook.md describes them.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "text/expected.hpp"

namespace dinal::notebook {

/// Serves all requests on standard input and answers on the descriptor `answers`. Script output goes to standard output
/// and error as usual, and precedes the answer. Returns false if the descriptor is not open.
bool run_kernel(lua_State* L, int answers);

/// Installs two kernels, one of them with --safe, into the user's Jupyter folder: $JUPYTER_DATA_DIR, jupyter in
/// $XDG_DATA_HOME, or ~/.local/share/jupyter. Each is a kernel.json with the Python program beside it. Returns a
/// description of the result.
text::Expected<std::string> install_kernel();

/// dinal_kernel.py, embedded by CMake.
extern const char* const kernel_script;

}  // namespace dinal::notebook
