// Calls from the program into Lua: with Ctrl-C armed, and with an error turned into the words that the user reads.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// lua_pcall. After an error the top of the stack is text: the message and, when the error came through more than one
/// Lua function, a short trace of these, a line for each. interrupt_requested() tells whether Ctrl-C was pressed.
int call(lua_State* L, int arguments, int results);

/// Takes the message from the top of the stack, about a chunk that could not be loaded from `file` (nullptr: it was in
/// no file), or of a chunk that ran out of memory: the words for the user, with the line.
std::string told_error(lua_State* L, const char* file);

/// Takes the text from the top of the stack.
std::string take_text(lua_State* L);

/// luaL_loadfile for those who start scripts (the argument of main, :load, the init file), which takes its time and
/// memory like any other code. In safe mode no bytecode, and only files that a script may read.
int load_file(lua_State* L, const char* file);

}  // namespace dinal::prompt
