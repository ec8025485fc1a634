// The prompt for other programs: requests and answers as lines of JSON.
//
// `dinal --kernel=N` reads requests from standard input, one JSON object a line, and writes answers, one JSON object a
// line, to the open file descriptor N. Scripts print to standard output and standard error; this output is written
// before the answer. SIGINT interrupts the current request; the end of standard input ends the program.
//
//     {"id": 1, "do": "execute", "code": "x = 2\nx"}
// is answered by {"done": 1, "ok": true, "notice": ""}, or by "ok": false with an "error". Before that come, while the
// code runs, {"show": FORMS} for each picture and {"progress": "a line"} ("" in the end), and {"value": FORMS} for the
// value of the last line. FORMS maps MIME types to text: text/plain always, also text/html or image/svg+xml.
//     {"id": 2, "do": "complete", "before": "run:pl"}
// is answered by {"done": 2, "names": ["plot{"], "word": 2}: the names that may replace the last 2 bytes.
//     {"id": 3, "do": "inspect", "before": "sys", "after": "tem"}
// is answered by {"done": 3, "text": "..."}: the help for the name around the cursor.
//     {"id": 4, "do": "check", "code": "for i = 1, 3 do"}
// is answered by {"done": 4, "state": "incomplete"}, or complete, or invalid.
// A line has at most 16 MiB. Any other line is answered by {"done": ..., "wrong": "a sentence"}.
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
