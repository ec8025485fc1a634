#include "prompt/chunk.hpp"

#include <algorithm>
#include <cctype>
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
    lua_pop(L, 1);
    const bool statements = load(L, text);
    early = !statements && (ended_early(L, text) || early);
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

}  // namespace dinal::prompt
