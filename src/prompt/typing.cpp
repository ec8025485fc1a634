#include "prompt/typing.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>

#include "lua/bind.hpp"
#include "lua/tokens.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
namespace {

constexpr std::string_view grey = "\x1b[90m";
constexpr std::string_view plain = "\x1b[0m";

std::string_view colour_of(const lua::Token& token) {
    switch (token.kind) {
        case lua::TokenKind::keyword:
            return "\x1b[35m";
        case lua::TokenKind::number:
            return "\x1b[36m";
        case lua::TokenKind::string:
            return token.open ? "\x1b[31m" : "\x1b[32m";
        case lua::TokenKind::comment:
            return grey;
        default:
            return "";
    }
}

/// Runs `work` with Lua's errors (there is only the lack of memory) kept inside.
template <class Work>
void safely(lua_State* L, Work work) {
    const auto trampoline = [](lua_State* state) {
        auto& function = *static_cast<Work*>(lua_touserdata(state, 1));
        lua_settop(state, 0);
        function(state);
        return 0;
    };
    const int top = lua_gettop(L);
    lua_pushcfunction(L, trampoline);
    lua_pushlightuserdata(L, &work);
    lua_pcall(L, 1, 0, 0);
    lua_settop(L, top);
}

bool is_simple(std::string_view text, bool unicode) {
    return std::all_of(text.begin(), text.end(), [unicode](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0x20 && byte != 0x7F && (byte < 0x80 || unicode);
    });
}

}  // namespace

std::string in_colours(std::string_view text) {
    std::string result;
    std::size_t at = 0;
    for (const lua::Token& token : lua::tokens(text)) {
        result += text.substr(at, token.at - at);
        at = token.end();
        const std::string_view colour = colour_of(token);
        result.append(colour).append(token.text).append(colour.empty() ? "" : plain);
    }
    return result.append(text.substr(at));
}

Painted paint(lua_State* L, std::string_view prompt, const std::string& pending, std::string_view line,
              std::size_t cursor) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::size_t before = text::columns(prompt);
    const std::size_t used = before + text::columns(line);
    constexpr std::size_t spare = 2;  // a row that is full to its end may have been wrapped already
    if (used + spare >= screen.width || !is_simple(prompt, screen.unicode) || !is_simple(line, screen.unicode)) {
        return {};
    }
    std::string hint;
    if (cursor == line.size() && !line.empty()) {
        safely(L, [&](lua_State* state) { hint = signature_hint(state, pending + std::string(line)); });
        constexpr std::size_t gap = 2;
        hint = text::cut_to_columns(hint, screen.width - used - spare > gap ? screen.width - used - spare - gap : 0);
    }
    // octal where a digit follows: \x1b7 would be one character
    std::string text = "\0337\r";
    text += before > 0 ? fmt::format("\x1b[{}C", before) : "";
    text += in_colours(line);
    text += hint.empty() ? "" : fmt::format("  {}{}{}", grey, hint, plain);
    return {text + "\x1b[K\0338", !hint.empty()};
}

Completion complete_safely(lua_State* L, const std::string& before) {
    Completion completion;
    safely(L, [&](lua_State* state) { completion = complete(state, before); });
    return completion;
}

}  // namespace dinal::prompt
