// Calls from the program into Lua: with Ctrl-C armed, and with an error turned into the words that the user reads.
#pragma once

#include <lua.hpp>

#include <string>

namespace dinal {

/// lua_pcall. After an error the top of the stack is text: the message and, when the error came through more than one
/// Lua function, a short trace of these, a line for each. interrupt_requested() tells whether Ctrl-C was pressed.
int call(lua_State* L, int arguments, int results);

/// Takes the text from the top of the stack.
std::string take_text(lua_State* L);

}  // namespace dinal
