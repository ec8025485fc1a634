// What is known about an error besides its message, from where it is raised to where it is printed.
//
// The value that a user's pcall sees stays a plain string, or what he raised himself; so what is known stands beside
// it, in the Lua state: the facts of our own errors, and what an error in M was seen to be while M still ran.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "text/expected.hpp"

namespace dinal::lua {

/// To be called with an error of ours when it is raised. The last few are remembered.
void remember_facts(lua_State* L, const text::Error& error);

/// The error of ours that the message tells, nullptr when it is of Lua or of the user. A message that was raised again
/// may have more words before it (the position of coroutine.wrap or error) and after it (a traceback).
const text::Error* facts_of(lua_State* L, std::string_view message);

/// What is said about an error besides its message.
struct Remarks {
    std::string suggestion;  ///< the end of the sentence, "; did you mean 'system'?"
    std::string excerpt;     ///< the line of source with a mark: lines, each with a newline before it
    std::string during;      ///< "\n  in M at t = 0.5", when the error came out of an excitation
};

/// Finds the remarks on the error value at the index, while the functions in which it happened still stand on the
/// stack; or on the message about what the function at the other index (0 when there is none) has returned.
using Witness = Remarks (*)(lua_State* L, int error, int function);

/// Who is asked about errors in M. Without one there are no remarks.
void set_witness(lua_State* L, Witness witness);

/// The handler for calls of M: leaves the error value alone, and remembers what the witness says about it.
int witness_error(lua_State* L);

/// The same for the message on the top, which is about what the function at the index has returned.
void witness_result(lua_State* L, int function);

/// Adds to what is remembered about the error value on the top for which argument (t) a function (M) was asked.
void remember_argument(lua_State* L, const char* function, const char* argument, double value);

/// To be called when the error value that is remembered is about to be raised once more: the remarks on it stay, also
/// when it then comes out of an outer M.
void keep_remarks(lua_State* L);

/// What is remembered about the error value at the index, nullptr when nothing is.
const Remarks* remembered_remarks(lua_State* L, int index);

}  // namespace dinal::lua
