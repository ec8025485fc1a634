// Data about an error besides its message, from where it is raised to where it is printed.
//
// A user's pcall sees a plain string, or the value that the user raised. So the data are stored in the Lua state: facts
// about dinal's own errors, and remarks on an error in M, made while M was still on the stack.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "text/expected.hpp"

namespace dinal::lua {

/// Stores the facts of an error raised by dinal. Only the last few are kept.
void remember_facts(lua_State* L, const text::Error& error);

/// The error of dinal behind a message; nullptr for errors of Lua or of the user. A message raised again may have a
/// position in front (by coroutine.wrap or error) and a traceback at the end.
const text::Error* facts_of(lua_State* L, std::string_view message);

/// Additions to an error message.
struct Remarks {
    std::string suggestion;  ///< end of the sentence, "; did you mean 'system'?"
    std::string excerpt;     ///< source line with a mark: lines, each with a newline before it
    std::string during;      ///< "\n  in M at t = 0.5" for an error in an excitation
};

/// Makes the remarks on the error value at index `error`, while its functions are still on the stack. If `function` is
/// not 0, the error is about the result of the function at that index.
using Witness = Remarks (*)(lua_State* L, int error, int function);

/// Sets the function that makes remarks on errors in M. Without it errors have no remarks.
void set_witness(lua_State* L, Witness witness);

/// The message handler for calls of M. It returns the error value and stores the witness's remarks.
int witness_error(lua_State* L);

/// Stores remarks on the message on the top about a result of the function at the index.
void witness_result(lua_State* L, int function);

/// Adds the argument (t) with which a function (M) was called to the remarks on the error value on the top.
void remember_argument(lua_State* L, const char* function, const char* argument, double value);

/// Keeps the remarks when their error value is about to be raised again, possibly through an outer M.
void keep_remarks(lua_State* L);

/// Forgets the remarks: because two inputs of the prompt may fail with the same text, "input:1: ...", in different
/// lines.
void forget_remarks(lua_State* L);

/// The stored remarks on the error value at the index, or nullptr.
const Remarks* remembered_remarks(lua_State* L, int index);

}  // namespace dinal::lua
