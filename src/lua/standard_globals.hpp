// The table `dinal`, and the globals that Lua and dinal bring, apart from those that the user makes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Makes the table, and leaves it on the top of the stack.
void make_dinal_table(lua_State* L);

/// Pushes the table that make_dinal_table() made, whatever the user has done to the global of that name.
void push_dinal_table(lua_State* L);

/// The value at the index is the table of all globals.
bool is_global_table(lua_State* L, int index);

/// Copies all fields of the table below the top into the table on the top.
void copy_fields(lua_State* L);

/// To be called once all globals of Lua and dinal stand: remembers them.
void note_standard_globals(lua_State* L);

/// Pushes a table of them: name -> value.
void push_standard_globals(lua_State* L);

/// Pushes a table of the libraries among them as they were at the start: library -> a copy of its fields.
void push_standard_fields(lua_State* L);

/// Whether a global of that name was there at the start, and is something else now; the same of a field in a library
/// that was there at the start: math.pi.
bool is_overwritten(lua_State* L, std::string_view name, std::string_view field = {});

/// The table `dinal` has it, too.
bool is_of_dinal(lua_State* L, std::string_view name);

/// The names of all globals that are not among them, or hold something else now; sorted.
std::vector<std::string> users_globals(lua_State* L);

/// Takes away the user's globals and gives the standard ones back.
void reset_globals(lua_State* L);

// What a script writes to the terminal makes way for no progress line: that one goes first.

/// Replaces print, io.write and file:write, where they are, by functions that erase the progress line and then do the
/// same.
void open_terminal_output(lua_State* L);

}  // namespace dinal::lua
