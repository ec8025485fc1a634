#include "errors/bare_value.hpp"

#include <fmt/format.h>

#include <vector>

#include "lua/tokens.hpp"
#include "text/words.hpp"

namespace dinal::errors {
namespace {

bool compiles(lua_State* L, const std::string& text) {
    const bool good = luaL_loadbufferx(L, text.data(), text.size(), "=part", "t") == LUA_OK;
    lua_pop(L, 1);
    return good;
}

/// The line without a remark and semicolons behind it.
std::string_view code_of(std::string_view line) {
    std::size_t end = 0;
    for (const lua::Token& token : lua::tokens(line)) {
        if (token.kind != lua::TokenKind::comment && !token.is(";")) end = token.end();
    }
    return text::trimmed(line.substr(0, end), " \t");
}

bool is_value(lua_State* L, std::string_view code) {
    return !code.empty() && compiles(L, "return " + std::string(code)) && !compiles(L, std::string(code));
}

}  // namespace

std::string bare_value(lua_State* L, const SourceText& source, int line, const lua::SyntaxMessage& message) {
    luaL_checkstack(L, LUA_MINSTACK, "for a value alone on a line");
    if (message.complaint != "syntax error" && message.complaint != "unexpected symbol") return "";
    // A name is found out to be no statement only by what follows it, on a later line.
    for (int number = line; number >= source.first_line && number + 2 > line; --number) {
        const std::string_view code = code_of(source.line(number));
        if (!is_value(L, code)) continue;
        constexpr std::size_t longest = 40;
        const std::string where = number == line ? "a value alone" : fmt::format("line {}, a value alone,", number);
        return fmt::format("; {} is not a statement: print({}) shows it", where, code.size() > longest ? "..." : code);
    }
    return "";
}

}  // namespace dinal::errors
