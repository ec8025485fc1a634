// Lua text cut into tokens: the one place that knows where a string or a comment ends.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace dinal::lua {

enum class TokenKind { name, keyword, number, string, comment, symbol };

struct Token {
    TokenKind kind = TokenKind::symbol;
    std::string_view text;
    std::size_t at = 0;  ///< where it begins in the text
    int line = 1;        ///< on which it begins
    bool open = false;   ///< a string or a long comment whose end is missing

    [[nodiscard]] std::size_t end() const { return at + text.size(); }
    [[nodiscard]] bool is(std::string_view other) const { return kind != TokenKind::string && text == other; }
    /// 1 of a bracket that opens, -1 of one that closes.
    [[nodiscard]] int nesting() const {
        return is("(") || is("{") || is("[") ? 1 : is(")") || is("}") || is("]") ? -1 : 0;
    }
};

/// All tokens of a text, which need not compile; white space is left out. They refer to the text.
std::vector<Token> tokens(std::string_view text);

/// All keywords of Lua.
const std::vector<std::string_view>& keywords();

}  // namespace dinal::lua
