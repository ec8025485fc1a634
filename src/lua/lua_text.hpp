// Lua text: its tokens, and small pieces such as names, functions and numbers. Strings and comments are recognised only
// here.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

enum class TokenKind { name, keyword, number, string, comment, symbol };

struct Token {
    TokenKind kind = TokenKind::symbol;
    std::string_view text;
    std::size_t at = 0;  ///< index of its first byte
    int line = 1;        ///< line of its first byte
    bool open = false;   ///< whether it is a string or long comment without an end

    std::size_t end() const { return at + text.size(); }
    bool is(std::string_view other) const { return kind != TokenKind::string && text == other; }
    /// 1 for an opening bracket, -1 for a closing one, otherwise 0.
    int nesting() const { return is("(") || is("{") || is("[") ? 1 : is(")") || is("}") || is("]") ? -1 : 0; }
};

using Tokens = std::vector<Token>;

/// All tokens of a text, which need not compile; without white space. They refer to the text.
Tokens tokens(std::string_view text);

const std::vector<std::string_view>& keywords();

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
