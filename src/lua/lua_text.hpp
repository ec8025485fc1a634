// Small pieces of Lua text: names, functions, numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// The string at `index`, as long as it stays on the stack; a number there becomes one. Empty when it is neither.
inline std::string_view text_at(lua_State* L, int index) {
    std::size_t size = 0;
    const char* start = lua_tolstring(L, index, &size);
    return {start, size};
}

/// The texts among the keys of the table at `index`, sorted.
std::vector<std::string> text_keys(lua_State* L, int index);

/// A name as in `t.name = 1`, and no keyword.
bool is_name(std::string_view text);

/// The names in a piece of Lua text that may be variables (no fields, no words in strings or comments), each once.
std::vector<std::string> free_names(std::string_view source);

/// The functions in a text that compiles, from the word `function` to their `end`, that begin on one line and end on
/// the other (counted from 1).
std::vector<std::string_view> functions_between(std::string_view text, int first_line, int last_line);

/// A float that reads back exactly, and as a float.
std::string float_text(double number);

}  // namespace dinal::lua
