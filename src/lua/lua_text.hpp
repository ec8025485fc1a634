// Small pieces of Lua text: names, functions, numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// The string at `index`, valid while it is on the stack; converts a number there. Empty for other values.
inline std::string_view text_at(lua_State* L, int index) {
    std::size_t size = 0;
    const char* start = lua_tolstring(L, index, &size);
    return {start, size};
}

/// The string keys of the table at `index`, sorted.
std::vector<std::string> text_keys(lua_State* L, int index);

/// Returns whether the text is a name as in `t.name = 1`, not a keyword.
bool is_name(std::string_view text);

/// The possible variables in a piece of Lua text (no fields, strings or comments), each once.
std::vector<std::string> free_names(std::string_view source);

/// The functions in a text that compiles, from the word `function` to their `end`, that begin on the first and end on
/// the last line (from 1).
std::vector<std::string_view> functions_between(std::string_view text, int first_line, int last_line);

/// A number as Lua text that reads back exactly, and as a float.
std::string float_text(double number);

}  // namespace dinal::lua
