#include "lua/lua_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string>

#include "text/words.hpp"

namespace dinal::lua {

namespace {

using text::is_digit;
using text::is_name_char;

constexpr std::array<std::string_view, 10> long_symbols = {"...", "..", "==", "~=", "<=", ">=", "//", "::", "<<", ">>"};

class Cutter {
public:
    explicit Cutter(std::string_view text) : text_(text) {}

    Tokens all() {
        Tokens found;
        while (skip_space()) {
            Token token = next();
            line_ += static_cast<int>(std::ranges::count(token.text, '\n'));
            at_ = token.end();
            found.push_back(token);
        }
        return found;
    }

private:
    bool skip_space() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) {
            line_ += text_[at_++] == '\n' ? 1 : 0;
        }
        return at_ < text_.size();
    }

    Token token(TokenKind kind, std::size_t end, bool open = false) const {
        return {kind, text_.substr(at_, end - at_), at_, line_, open};
    }

    char peek(std::size_t place) const { return place < text_.size() ? text_[place] : '\0'; }

    Token next() {
        const char c = text_[at_];
        if (text_.substr(at_, 2) == "--") {
            return comment();
        }
        if (c == '"' || c == '\'') {
            return quoted_string(c);
        }
        if (long_bracket(at_) >= 0) {
            return bracketed(TokenKind::string, at_);
        }
        if (is_digit(c) || (c == '.' && is_digit(peek(at_ + 1)))) {
            return number();
        }
        if (is_name_char(c)) {
            return name();
        }
        for (const std::string_view symbol : long_symbols) {
            if (text_.substr(at_, symbol.size()) == symbol) {
                return token(TokenKind::symbol, at_ + symbol.size());
            }
        }
        return token(TokenKind::symbol, at_ + 1);
    }

    Token name() {
        std::size_t end = at_;
        while (is_name_char(peek(end))) {
            ++end;
        }
        Token result = token(TokenKind::name, end);
        if (std::find(keywords().begin(), keywords().end(), result.text) != keywords().end()) {
            result.kind = TokenKind::keyword;
        }
        return result;
    }

    /// Reads a number as Lua does: with all following letters and digits, as in 0xend.
    Token number() {
        const bool hexadecimal = peek(at_) == '0' && (peek(at_ + 1) == 'x' || peek(at_ + 1) == 'X');
        std::size_t end = at_;
        while (is_name_char(peek(end)) || (peek(end) == '.' && peek(end + 1) != '.')) {
            const char letter = text::lower(peek(end));
            const bool exponent = letter == (hexadecimal ? 'p' : 'e');
            ++end;
            if (exponent && (peek(end) == '+' || peek(end) == '-')) {
                ++end;
            }
        }
        return token(TokenKind::number, end);
    }

    Token quoted_string(char quote) {
        std::size_t end = at_ + 1;
        while (end < text_.size() && text_[end] != quote) {
            if (text_[end] == '\n') {
                return token(TokenKind::string, end, true);
            }
            const bool gap = text_[end] == '\\' && peek(end + 1) == 'z';  // \z skips white space, including newlines
            end += text_[end] == '\\' ? 2 : 1;
            while (gap && std::isspace(static_cast<unsigned char>(peek(end))) != 0) {
                ++end;
            }
        }
        const bool open = end >= text_.size();
        return token(TokenKind::string, open ? text_.size() : end + 1, open);
    }

    Token comment() {
        if (long_bracket(at_ + 2) >= 0) {
            return bracketed(TokenKind::comment, at_ + 2);
        }
        return token(TokenKind::comment, std::min(text_.find('\n', at_), text_.size()));
    }

    /// The number of = in the long bracket at `open`; -1 if there is none.
    int long_bracket(std::size_t open) const {
        if (peek(open) != '[') {
            return -1;
        }
        const std::size_t second = std::min(text_.find_first_not_of('=', open + 1), text_.size());
        return peek(second) == '[' ? static_cast<int>(second - open - 1) : -1;
    }

    Token bracketed(TokenKind kind, std::size_t open) {
        const std::string close = "]" + std::string(static_cast<std::size_t>(long_bracket(open)), '=') + "]";
        const std::size_t end = text_.find(close, open + close.size());
        const bool missing = end == std::string_view::npos;
        return token(kind, missing ? text_.size() : end + close.size(), missing);
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
};

}  // namespace

Tokens tokens(std::string_view text) {
    return Cutter(text).all();
}

const std::vector<std::string_view>& keywords() {
    static const std::vector<std::string_view> all = {
        "and", "break", "do",  "else", "elseif", "end",    "false",  "for",  "function", "goto",  "if",
        "in",  "local", "nil", "not",  "or",     "repeat", "return", "then", "true",     "until", "while"};
    return all;
}

std::vector<std::string> text_keys(lua_State* L, int index) {
    index = lua_absindex(L, index);
    std::vector<std::string> keys;
    for (lua_pushnil(L); lua_next(L, index) != 0; lua_pop(L, 1)) {
        if (lua_type(L, -2) == LUA_TSTRING) keys.emplace_back(text_at(L, -2));
    }
    std::ranges::sort(keys);
    return keys;
}

bool is_name(std::string_view text) {
    const Tokens all = tokens(text);
    return all.size() == 1 && all.front().kind == TokenKind::name && all.front().text.size() == text.size();
}

std::vector<std::string> free_names(std::string_view source) {
    std::vector<std::string> names;
    bool field = false;  // after . or : a name is that of a field
    for (const Token& token : tokens(source)) {
        if (token.kind == TokenKind::comment) {
            continue;
        }
        const bool fresh = !text::contains(names, token.text);
        if (token.kind == TokenKind::name && !field && fresh) {
            names.emplace_back(token.text);
        }
        field = token.is(".") || token.is(":");
    }
    return names;
}

std::vector<std::string_view> functions_between(std::string_view text, int first_line, int last_line) {
    struct Block {
        std::size_t start;
        bool wanted;
    };
    std::vector<Block> open;
    std::vector<std::string_view> found;
    for (const Token& token : tokens(text)) {
        if (token.kind != TokenKind::keyword) {
            continue;
        }
        if (token.is("function") || token.is("do") || token.is("if") || token.is("repeat")) {
            open.push_back({token.at, token.is("function") && token.line == first_line});
        } else if ((token.is("end") || token.is("until")) && !open.empty()) {
            if (open.back().wanted && token.line == last_line) {
                found.push_back(text.substr(open.back().start, token.end() - open.back().start));
            }
            open.pop_back();
        }
    }
    return found;
}

std::string float_text(double number) {
    if (std::isnan(number)) {
        return "0/0";
    }
    if (std::isinf(number)) {
        return number > 0 ? "math.huge" : "-math.huge";
    }
    const std::string text = fmt::format("{}", number);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
}

}  // namespace dinal::lua
