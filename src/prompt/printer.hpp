// Values as the prompt shows them: numbers plain, strings quoted, tables short, objects as cards, the rest by tostring.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "terminal/display.hpp"

namespace dinal::prompt {

/// The text for the value at `index`: a table on one line when it fits, else on a screen at most.
/// Tables are read raw; the only user's code that may run is __tostring, and its errors become part of the text. Within
/// call() only: Ctrl-C during it is a Lua error.
std::string show(lua_State* L, int index, const terminal::Display& screen);

/// The beginning of it on one line of `width` columns.
std::string show_line(lua_State* L, int index, const terminal::Display& screen, std::size_t width);

}  // namespace dinal::prompt
