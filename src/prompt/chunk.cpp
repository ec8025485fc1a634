#include "prompt/chunk.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>
#include <vector>

#include "lua/lua_message.hpp"
#include "lua/lua_text.hpp"
#include "lua/tokens.hpp"

namespace dinal::prompt {
namespace {

// The variable keeps Lua from making a tail call of `return f(x)`, which would take f's name and place from messages.
constexpr std::string_view returning = "local dinal_prompt <close> = nil; return ";

bool load(lua_State* L, const std::string& text) {
    return luaL_loadbufferx(L, text.data(), text.size(), prompt_chunk, "t") == LUA_OK;
}

/// Pops the function or the message.
bool loads(lua_State* L, const std::string& text) {
    const bool good = load(L, text);
    lua_pop(L, 1);
    return good;
}

/// "...\\" or "...\\z  "
bool goes_on(std::string_view text) {
    if (text.ends_with('\\')) {
        return true;
    }
    const std::size_t last = text.find_last_not_of(" \t\r\n");
    return last != std::string_view::npos && last > 0 && text.substr(last - 1, 2) == "\\z";
}

/// The message on the top of the stack says that the chunk ended too early.
bool ended_early(lua_State* L, std::string_view chunk) {
    const std::string_view message = lua::text_at(L, -1);
    // A string in quotes ends on its line, unless a backslash takes the newline in.
    return lua::is_about_end(message) && (!lua::is_about_unfinished_string(message) || goes_on(chunk));
}

std::string returned(std::string_view expression) {
    return std::string(returning).append(expression);
}

/// The text without the semicolons (and comments) at its end; the same text when there are none.
std::string_view without_semicolons(std::string_view text) {
    const std::vector<lua::Token> all = lua::tokens(text);
    std::string_view result = text;
    for (auto token = all.rbegin(); token != all.rend(); ++token) {
        if (token->is(";")) {
            result = text.substr(0, token->at);
        } else if (token->kind != lua::TokenKind::comment) {
            break;
        }
    }
    return result;
}

/// Where the last value of a text may begin: after a semicolon, and at each line. The last place comes first.
std::vector<std::size_t> possible_cuts(const std::string& text) {
    std::vector<std::size_t> cuts;
    for (std::size_t cut = text.rfind('\n'); cut != std::string::npos && cut > 0; cut = text.rfind('\n', cut - 1)) {
        cuts.push_back(cut);
    }
    for (const lua::Token& token : lua::tokens(text)) {
        if (token.is(";")) {
            cuts.push_back(token.at);
        }
    }
    std::sort(cuts.rbegin(), cuts.rend());
    return cuts;
}

/// A block whose last lines are an expression becomes one that returns it. Pushes the function when there is one.
/// NOTE: `cautious` leaves alone lines that Lua may read as the rest of the line before: (f)(), "s", {...}, -x.
bool load_with_last_value(lua_State* L, Chunk& chunk, const std::string& text, bool cautious) {
    for (const std::size_t cut : possible_cuts(text)) {
        const std::size_t first = text.find_first_not_of(" \t\r\n", cut + 1);
        if (first == std::string::npos) {
            continue;
        }
        const char letter = text[first];
        if (cautious && text[cut] == '\n' && std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '_') {
            continue;
        }
        const std::string begin = text.substr(0, cut + 1);
        const std::string last = text.substr(cut + 1);
        if (loads(L, begin) && loads(L, returned(last))) {
            chunk.statements = begin;
            chunk.expression = last;
            return load(L, begin + returned(last));
        }
    }
    return false;
}

/// The innermost bracket that is not closed.
std::optional<lua::Token> open_bracket(std::string_view text) {
    std::vector<lua::Token> open;
    for (const lua::Token& token : lua::tokens(text)) {
        if (token.is("(") || token.is("{") || token.is("[")) {
            open.push_back(token);
        } else if ((token.is(")") || token.is("}") || token.is("]")) && !open.empty()) {
            open.pop_back();
        }
    }
    return open.empty() ? std::nullopt : std::optional(open.back());
}

char partner_of(char bracket) {
    return bracket == '(' ? ')' : bracket == '[' ? ']' : '}';
}

/// What the message on the top of the stack, of a chunk that ended too early, says is missing.
std::string what_is_missing(lua_State* L, std::string_view text) {
    const std::string message(lua::text_at(L, -1));
    const std::size_t line = message.find(':') + 1, words = message.find(": ") + 2;  // input:1: ...
    const std::string number = message.substr(line, words - 2 - line);
    const auto parsed = lua::syntax_message(std::string_view(message).substr(words));
    if (!parsed || parsed->expected.empty() || parsed->expected.front() == '<') {
        const auto open = open_bracket(text);
        return open ? fmt::format("{} of line {} waits for {}", open->text, open->line, partner_of(open->text.front()))
                    : fmt::format("line {} goes on", number);
    }
    if (parsed->opened.empty()) {  // on that line
        return fmt::format("line {} waits for {}", number, parsed->expected);
    }
    return fmt::format("{} of line {} waits for {}", parsed->opened, parsed->opened_line, parsed->expected);
}

/// The words after `return`, when that is the first word.
std::string_view without_return(std::string_view text) {
    const std::vector<lua::Token> all = lua::tokens(text);
    return !all.empty() && all.front().is("return") ? text.substr(all.front().end()) : text;
}

}  // namespace

Chunk compile(lua_State* L, const std::string& text) {
    Chunk chunk{Compiled::ready, text, "", false};
    const std::string_view quiet = without_semicolons(text);
    chunk.silent = quiet.size() != text.size();
    const bool equals = !text.empty() && text[0] == '=';  // = x, as in Lua 5.2 and before
    const std::string_view expression = without_return(quiet.substr(equals ? 1 : 0));
    if (load(L, returned(expression))) {
        chunk.statements.clear();
        chunk.expression = expression;
        return chunk;
    }
    bool early = ended_early(L, text);
    chunk.waits = early ? what_is_missing(L, text) : "";
    lua_pop(L, 1);
    const bool statements = load(L, text);
    const bool statements_early = !statements && ended_early(L, text);
    chunk.waits = statements_early ? what_is_missing(L, text) : chunk.waits;
    early = !statements && (statements_early || early);
    if (quiet.find_first_of("\n;") != std::string::npos) {
        const int top = lua_gettop(L);
        // NOTE: a block may end in a name, after which Lua expects more.
        if (load_with_last_value(L, chunk, std::string(quiet), statements || early)) {
            lua_remove(L, top);
            return chunk;
        }
        lua_settop(L, top);
    }
    chunk.silent = false;
    chunk.result = statements ? Compiled::ready : early ? Compiled::incomplete : Compiled::wrong;
    return chunk;
}

bool only_looks(const Chunk& chunk) {
    const std::vector<lua::Token> all = lua::tokens(chunk.expression);
    const auto code = std::count_if(all.begin(), all.end(),
                                    [](const lua::Token& token) { return token.kind != lua::TokenKind::comment; });
    return chunk.statements.empty() && code == 1 && all.front().kind == lua::TokenKind::name;
}

}  // namespace dinal::prompt
