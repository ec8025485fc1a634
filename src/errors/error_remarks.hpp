// What the program says about an error besides its message: the line of source with a mark, a likely spelling, and the
// time for which M was asked.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::errors {

struct Remarks {
    std::string suggestion;  ///< the end of the sentence, "; did you mean 'system'?"
    std::string excerpt;     ///< lines, each with a newline before it
    std::string during;      ///< "\n  in M at t = 0.5", when the error came out of an excitation
};

/// About the error value at `index`. To be asked while the functions in which it happened still stand on the stack,
/// that is in a message handler; later, what is gone is left out.
Remarks remarks_on(lua_State* L, int index);

/// About the message at `index`, of a chunk that did not compile. `file` is its name, nullptr when it was in no file.
Remarks remarks_on_syntax(lua_State* L, int index, const char* file);

/// The handler for calls of M: leaves the error value alone, and remembers the remarks on it for remarks_on().
int remember_remarks(lua_State* L);

/// Remembers remarks on the message on the top, which is about what the function at `index` has returned.
void remember_result(lua_State* L, int index);

/// Adds to the remarks that are remembered about the error value on the top for which t M was asked.
void remember_time(lua_State* L, double t);

/// To be called when the error value that is remembered is about to be raised once more: the remarks on it stay, also
/// when it then comes out of an outer M.
void keep_remarks(lua_State* L);

}  // namespace dinal::errors
