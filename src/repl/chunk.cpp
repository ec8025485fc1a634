#include "repl/chunk.hpp"

#include <cctype>
#include <string_view>

namespace dinal {
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

/// The message on the top of the stack says that the text ended too early.
bool ended_early(lua_State* L) {
    constexpr std::string_view mark = "<eof>";
    std::size_t size = 0;
    const char* text = lua_tolstring(L, -1, &size);
    const std::string_view message(text, size);
    return size >= mark.size() && message.substr(size - mark.size()) == mark;
}

std::string returned(std::string_view expression) {
    return std::string(returning).append(expression);
}

/// A block whose last lines are an expression becomes one that returns it. Pushes the function when there is one.
/// NOTE: `cautious` leaves alone lines that Lua may read as the rest of the line before: (f)(), "s", {...}, -x.
bool load_with_last_value(lua_State* L, const std::string& text, bool cautious) {
    for (std::size_t cut = text.rfind('\n'); cut != std::string::npos && cut > 0; cut = text.rfind('\n', cut - 1)) {
        const std::size_t first = text.find_first_not_of(" \t\r\n", cut);
        if (first == std::string::npos) {
            continue;
        }
        const char letter = text[first];
        if (cautious && std::isalnum(static_cast<unsigned char>(letter)) == 0 && letter != '_') {
            continue;
        }
        const std::string begin = text.substr(0, cut + 1);
        const std::string last = text.substr(cut + 1);
        if (loads(L, begin) && loads(L, returned(last))) {
            return load(L, begin + returned(last));
        }
    }
    return false;
}

}  // namespace

Compiled compile(lua_State* L, const std::string& text) {
    const bool equals = !text.empty() && text[0] == '=';  // = x, as in Lua 5.2 and before
    if (load(L, returned(std::string_view(text).substr(equals ? 1 : 0)))) {
        return Compiled::ready;
    }
    bool early = ended_early(L);
    lua_pop(L, 1);
    const bool statements = load(L, text);
    early = !statements && (ended_early(L) || early);
    if (early) {
        return Compiled::incomplete;
    }
    if (text.find('\n') != std::string::npos) {
        const int top = lua_gettop(L);
        if (load_with_last_value(L, text, statements)) {
            lua_remove(L, top);
            return Compiled::ready;
        }
        lua_settop(L, top);
    }
    return statements ? Compiled::ready : Compiled::wrong;
}

}  // namespace dinal
