// Names that were probably meant: for an error that follows a nil where the user expected something.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// What helps with an error.
struct Advice {
    std::string end_of_sentence;  ///< "; did you mean 'system'?", or ""
    std::string culprit = {};     ///< what it has found out to be the reason: "; 'tend' is nil"
};

/// `frame` is where it happened, nullptr when that is gone; `statement` its text, as far as it is known.
Advice help_with(lua_State* L, lua_Debug* frame, const text::Error& error, std::string_view statement);
Advice help_with(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement);

/// Pushes what the variable holds there: a local one (the innermost of that name), an outer one, a global one.
void push_variable(lua_State* L, lua_Debug* frame, std::string_view wanted);

/// The global names that a misspelt one may stand for, as the end of a sentence.
std::string similar_global(lua_State* L, std::string_view name);

/// The names that may be written after a variable of that name and a dot: raw keys, those of its __index tables, and
/// members. Runs no code of the user. The value is on the top of the stack.
std::vector<std::string> member_names(lua_State* L);

/// "'theta_0' is nil, so theta0 is not given": a global, or a field of a table, that is not there and stands alone as
/// the value of an option in the text. A field only where another one has nearly its name: it may be left out on
/// purpose.
std::string nil_option(lua_State* L, lua_Debug* frame, std::string_view text);

// What others write as a function, or as a row that is not there: max(v) for v:max(), and how many rows there are.

/// The method that an argument has and that was called as a function: "; did you mean 'run.theta:max()'?", or "". To
/// be asked while the call still stands on the stack.
std::string meant_method(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

/// Of an index behind which there is nothing: "; 'run.events' has 6 elements, and n is 7", and the word to be marked.
struct MissingElement {
    std::string end_of_sentence, culprit;
};
MissingElement missing_element(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message,
                               std::string_view statement);

}  // namespace dinal::errors
