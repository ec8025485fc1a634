// Values as the prompt shows them: plain numbers, quoted strings, short tables, objects as cards, others by tostring.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "terminal/display.hpp"

namespace dinal::prompt {

/// The text for the value at `index`: a table on one line if it fits, otherwise on at most one screen. Reads tables
/// raw; the only user code that may run is __tostring, whose errors become part of the text. Requires call(): Ctrl-C is
/// a Lua error.
std::string show(lua_State* L, int index, const terminal::Display& screen);

/// The beginning of the text on one line of `width` columns.
std::string show_line(lua_State* L, int index, const terminal::Display& screen, std::size_t width);

}  // namespace dinal::prompt
