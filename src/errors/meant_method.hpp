// What others write as a function, or as a row that is not there: max(v) for v:max(), and how many rows there are.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"

namespace dinal::errors {

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
