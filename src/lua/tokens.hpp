// Splits Lua text into tokens; strings and comments are recognised only here.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

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

/// All tokens of a text, which need not compile; without white space. They refer to the text.
std::vector<Token> tokens(std::string_view text);

/// All keywords of Lua.
const std::vector<std::string_view>& keywords();

}  // namespace dinal::lua
