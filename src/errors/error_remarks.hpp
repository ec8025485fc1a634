// What the program says about an error besides its message: the line of source with a mark, a likely spelling, and the
// time for which M was asked. It reads the facts of our own errors, and takes apart the words of Lua's.
#pragma once

#include "lua/error_memory.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// About the error value at `index`. To be asked while the functions in which it happened still stand on the stack,
/// that is in a message handler; later, what is gone is left out.
lua::Remarks remarks_on(lua_State* L, int index);

/// About the message at `index`, of a chunk that did not compile. `file` is its name, nullptr when it was in no file.
lua::Remarks remarks_on_syntax(lua_State* L, int index, const char* file);

/// The witness of errors in M: nothing is remembered yet about the error value at `error`. When it is a message about
/// what a function has returned, that one is at `function`; else that is 0.
lua::Remarks first_remarks(lua_State* L, int error, int function);

}  // namespace dinal::errors
