// What a script writes to the terminal makes way for no progress line: that one goes first.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Replaces print, io.write and file:write, where they are, by functions that erase the progress line and then do the
/// same.
void open_terminal_output(lua_State* L);

}  // namespace dinal::lua
