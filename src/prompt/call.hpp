// Calls into Lua with Ctrl-C enabled and errors as text for the user.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// lua_pcall. After an error the top of the stack is text: the message and, if it passed several Lua functions, a short
/// trace, one line for each. interrupt_requested() tells whether Ctrl-C was pressed.
int call(lua_State* L, int arguments, int results);

/// Pops the message about a chunk that could not be loaded from `file` (nullptr: not from a file) or ran out of memory;
/// returns the text for the user, with the line.
std::string load_error_text(lua_State* L, const char* file);

/// Pops the text from the top of the stack.
std::string take_text(lua_State* L);

/// luaL_loadfile for the starters of scripts (main's argument, :load, the init file), with the limits of other code. In
/// safe mode refuses bytecode, and files that a script may not read.
int load_file(lua_State* L, const char* file);

}  // namespace dinal::prompt
