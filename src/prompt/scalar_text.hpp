// One value as the prompt shows it, when it is no plain table.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "terminal/display.hpp"

namespace dinal::prompt {

/// Alone on the screen, a value may take several lines; inside a table it gets a short form on one line.
enum class Place { alone, inside };

/// A table without a __tostring of its own: it is shown item by item.
bool is_plain_table(lua_State* L, int index);

/// The text for the value at `index`. Runs __tostring, whose errors become part of the text; Ctrl-C is a Lua error.
std::string scalar_text(lua_State* L, int index, Place place, const terminal::Display& screen);

}  // namespace dinal::prompt
