// The table `dinal` itself, for those who put something into it.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Makes the table, and leaves it on the top of the stack.
void make_dinal_table(lua_State* L);

/// Pushes the table that make_dinal_table() made, whatever the user has done to the global of that name.
void push_dinal_table(lua_State* L);

}  // namespace dinal::lua
