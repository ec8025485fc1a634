// The table `dinal` itself, for those who put something into it.
#pragma once

#include <lua.hpp>

namespace dinal {

/// Pushes the table that open_library() made, whatever the user has done to the global of that name.
void push_dinal_table(lua_State* L);

}  // namespace dinal
