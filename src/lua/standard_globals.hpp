// The table `dinal`, and the globals that Lua and dinal bring, apart from those that the user makes.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Makes the table, and leaves it on the top of the stack.
void make_dinal_table(lua_State* L);

/// Pushes the table that make_dinal_table() made, whatever the user has done to the global of that name.
void push_dinal_table(lua_State* L);

/// Copies all fields of the table below the top into the table on the top.
void copy_fields(lua_State* L);

/// To be called once all globals of Lua and dinal stand: remembers them.
void note_standard_globals(lua_State* L);

/// Pushes a table of them: name -> value.
void push_standard_globals(lua_State* L);

/// The names of all globals that are not among them, or hold something else now; sorted.
std::vector<std::string> users_globals(lua_State* L);

/// Takes away the user's globals and gives the standard ones back.
void reset_globals(lua_State* L);

}  // namespace dinal::lua
