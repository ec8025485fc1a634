#include "errors/meant_method.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "errors/misspelling.hpp"
#include "lua/bind.hpp"
#include "lua/tokens.hpp"
#include "text/sentences.hpp"
#include "text/words.hpp"

namespace dinal::errors {
namespace {

using Tokens = std::vector<lua::Token>;

bool opening(const lua::Token& token) {
    return token.is("(") || token.is("{") || token.is("[");
}
bool closing(const lua::Token& token) {
    return token.is(")") || token.is("}") || token.is("]");
}

/// name(first, rest), as it is written.
struct WrittenCall {
    std::string_view first, rest;
    bool simple = true;  ///< the first is a name, a field or a call, so that a colon may follow
};

std::optional<WrittenCall> call_of(std::string_view statement, std::string_view name) {
    const Tokens all = lua::tokens(statement);
    for (std::size_t i = 0; i + 2 < all.size(); ++i) {
        if (!all[i].is(name) || !all[i + 1].is("(")) continue;
        WrittenCall call;
        const std::size_t begin = all[i + 2].at;
        std::size_t comma = 0;
        int depth = 1;
        for (std::size_t k = i + 2; k < all.size(); ++k) {
            depth += opening(all[k]) ? 1 : closing(all[k]) ? -1 : 0;
            if (depth == 0) {
                const std::size_t end = comma > 0 ? comma : all[k].at;
                call.first = text::trimmed(statement.substr(begin, end - begin), " \n");
                if (comma > 0) call.rest = text::trimmed(statement.substr(comma + 1, all[k].at - comma - 1), " \n");
                return call.first.empty() ? std::nullopt : std::optional(call);
            }
            if (depth == 1 && comma == 0 && all[k].is(",")) comma = all[k].at;
            const bool path = all[k].kind == lua::TokenKind::name || all[k].is(".") || all[k].is(":") ||
                              closing(all[k]) || (opening(all[k]) && k > i + 2);
            call.simple = call.simple && (depth > 1 || comma > 0 || path);
        }
        return std::nullopt;
    }
    return std::nullopt;
}

bool has_method(lua_State* L, int index, std::string_view name) {
    const lua::Documented found = lua::documented(L, index);
    if (found.owner == nullptr || found.member != nullptr || lua_isuserdata(L, index) == 0) return false;
    const auto& members = found.owner->members;
    return std::any_of(members.begin(), members.end(), [name](const lua::Member& member) {
        return member.kind == lua::Kind::method && member.name == name;
    });
}

/// Something that is being passed in the innermost calls has such a method.
bool passes_its_owner(lua_State* L, std::string_view name) {
    constexpr int innermost = 4;
    lua_Debug frame{};
    for (int level = 0; level < innermost && lua_getstack(L, level, &frame) != 0; ++level) {
        for (int i = 1; const char* variable = lua_getlocal(L, &frame, i); ++i) {
            const bool passed = *variable == '(' && has_method(L, lua_gettop(L), name);
            lua_pop(L, 1);
            if (passed) return true;
        }
    }
    return false;
}

/// As a function that Lua can call: the length of its argument. Of objects of ours, so that no user's code runs.
int length(lua_State* L) {
    lua_pushinteger(L, luaL_len(L, 1));
    return 1;
}
int field(lua_State* L) {
    lua_gettable(L, 1);
    return 1;
}

/// Replaces the value on the top by its field; no code of a user runs.
void go_to_field(lua_State* L, std::string_view name) {
    if (lua_istable(L, -1)) {
        lua_pushlstring(L, name.data(), name.size());
        lua_rawget(L, -2);
        lua_remove(L, -2);
        return;
    }
    const bool ours = lua_isuserdata(L, -1) != 0 && lua::documented(L, -1).owner != nullptr;
    lua_pushcfunction(L, field);
    lua_insert(L, -2);
    lua_pushlstring(L, name.data(), name.size());
    if (!ours || lua_pcall(L, 2, 1, 0) != LUA_OK) {
        lua_settop(L, ours ? -2 : -4);
        lua_pushnil(L);
    }
}

/// How many elements the list on the top has; none when it is no list. Pops it.
std::optional<lua_Integer> taken_length(lua_State* L) {
    const bool ours = lua_isuserdata(L, -1) != 0 && lua::documented(L, -1).owner != nullptr;
    std::optional<lua_Integer> count;
    if (lua_istable(L, -1)) {
        count = static_cast<lua_Integer>(lua_rawlen(L, -1));
    } else if (ours) {
        lua_pushcfunction(L, length);
        lua_pushvalue(L, -2);
        if (lua_pcall(L, 1, 1, 0) == LUA_OK) count = lua_tointeger(L, -1);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return count;
}

/// The whole number that a token is, or that the variable of this name holds.
std::optional<lua_Integer> number_of(lua_State* L, lua_Debug* frame, const lua::Token& token) {
    if (token.kind == lua::TokenKind::name) {
        push_variable(L, frame, token.text);
    } else if (lua_stringtonumber(L, std::string(token.text).c_str()) == 0) {
        return std::nullopt;
    }
    int is_whole = 0;
    const lua_Integer number = lua_type(L, -1) == LUA_TNUMBER ? lua_tointegerx(L, -1, &is_whole) : 0;
    lua_pop(L, 1);
    return is_whole != 0 ? std::optional(number) : std::nullopt;
}

}  // namespace

std::string meant_method(lua_State* L, const lua::LuaMessage& message, std::string_view statement) {
    std::string_view name;
    if (message.calls && message.type == "nil" && message.kind == "global") {
        name = message.name;
    } else if (message.words.starts_with("bad argument #1 to '") && !message.quoted.empty()) {
        name = message.quoted.front();
    }
    const auto call = name.empty() ? std::nullopt : call_of(statement, name);
    const bool text = call && (call->first.front() == '"' || call->first.front() == '\'');  // save("run.mat")
    if (!call || text || !passes_its_owner(L, name)) return "";
    constexpr std::size_t longest = 60;
    const std::string object = call->simple ? std::string(call->first) : fmt::format("({})", call->first);
    const bool braces = call->rest.starts_with('{') && call->rest.ends_with('}');
    std::string meant =
        braces ? fmt::format("{}:{}{}", object, name, call->rest) : fmt::format("{}:{}({})", object, name, call->rest);
    if (meant.size() > longest || meant.find('\n') != std::string::npos) meant = fmt::format("x:{}(...)", name);
    return fmt::format("; did you mean '{}'?", meant);
}

MissingElement missing_element(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message,
                               std::string_view statement) {
    // Lua 5.4.4 says 'integer index', later ones '?'.
    if (message.type != "nil" || message.kind != "field" || (message.name != "integer index" && message.name != "?")) {
        return {};
    }
    MissingElement possible;
    const Tokens all = lua::tokens(statement);
    for (std::size_t i = 1; i + 1 < all.size(); ++i) {
        if (!all[i].is("[") || all[i - 1].kind != lua::TokenKind::name) continue;
        std::size_t first = i - 1;
        while (first >= 2 && all[first - 1].is(".") && all[first - 2].kind == lua::TokenKind::name) first -= 2;
        push_variable(L, frame, all[first].text);
        for (std::size_t k = first + 2; k < i; k += 2) go_to_field(L, all[k].text);
        const auto count = taken_length(L);
        if (!count) continue;
        const lua::Token& index = all[i + 1];
        const bool alone = i + 2 < all.size() && all[i + 2].is("]");
        const auto number = alone ? number_of(L, frame, index) : std::nullopt;
        if (number && *number >= 1 && *number <= *count) continue;  // it is there
        const std::size_t begin = all[first].at;
        MissingElement found{fmt::format("; '{}' has {}", statement.substr(begin, all[i].at - begin),
                                         text::counted(static_cast<std::size_t>(*count), "element")),
                             std::string(number ? index.text : all[i - 1].text)};
        if (number) {
            if (*number < 1) found.end_of_sentence += ", which are counted from 1";
            if (index.kind == lua::TokenKind::name)
                found.end_of_sentence += fmt::format(", and {} is {}", index.text, *number);
            return found;
        }
        if (possible.culprit.empty()) possible = found;
    }
    return possible;
}

}  // namespace dinal::errors
