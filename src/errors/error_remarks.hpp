// Additions to an error message: the source line with a mark, a likely spelling, and the time at which M was evaluated.
// Uses the stored facts of dinal's errors, and parses Lua's messages.
#pragma once

#include "lua/error_memory.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// The remarks on the error value at `index`. Call in a message handler, while the functions of the error are still on
/// the stack; afterwards parts are missing.
lua::Remarks remarks_on(lua_State* L, int index);

/// The remarks on the message at `index` about a chunk that did not compile. `file` is its name, or nullptr.
lua::Remarks remarks_on_syntax(lua_State* L, int index, const char* file);

/// The witness of errors in M, called once for each error value at `error`. For a message about a function's result,
/// `function` is the index of that function, otherwise 0.
lua::Remarks first_remarks(lua_State* L, int error, int function);

}  // namespace dinal::errors
