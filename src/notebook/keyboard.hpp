// A cell has no keyboard: what waits for a line of it says so, instead of reading nothing.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::notebook {

/// io.read(), io.lines() and the methods of io.stdin raise an error from now on; files are read as before.
void take_keyboard_away(lua_State* L);

}  // namespace dinal::notebook
