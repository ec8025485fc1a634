#include "lua/lua_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lua/tokens.hpp"

namespace dinal::lua {

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
    const std::vector<Token> all = tokens(text);
    return all.size() == 1 && all.front().kind == TokenKind::name && all.front().text.size() == text.size();
}

std::vector<std::string> free_names(std::string_view source) {
    std::vector<std::string> names;
    bool field = false;  // after . or : a name is that of a field
    for (const Token& token : tokens(source)) {
        if (token.kind == TokenKind::comment) {
            continue;
        }
        const bool fresh = std::ranges::find(names, token.text) == names.end();
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
