#include "errors/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::errors {

namespace {

constexpr int most_metatables = 10;  // an __index may lead to itself

/// Adds the string keys of the table on the top.
void add_keys(lua_State* L, std::vector<std::string>& names) {
    const std::vector<std::string> keys = lua::text_keys(L, -1);
    names.insert(names.end(), keys.begin(), keys.end());
}

/// Replaces the value on the top by the __index table of its metatable; returns false without one.
bool step_to_index_table(lua_State* L) {
    if (lua_getmetatable(L, -1) == 0) {
        return false;
    }
    lua::push_field(L, -1, "__index");
    lua_replace(L, -3);
    lua_pop(L, 1);
    return lua_istable(L, -1);
}

/// Calls visit(name) with each local variable and upvalue of the frame on the top of the stack.
template <class Visit>
void each_variable(lua_State* L, lua_Debug* frame, Visit visit) {
    if (frame == nullptr) {
        return;
    }
    for (int i = 1; const char* name = lua_getlocal(L, frame, i); ++i) {
        visit(name);
        lua_pop(L, 1);
    }
    lua_getinfo(L, "f", frame);
    const int function = lua_gettop(L);
    for (int i = 1; const char* name = lua_getupvalue(L, function, i); ++i) {
        visit(name);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
}

bool is_object_of_ours(lua_State* L, int index) {
    return lua_isuserdata(L, index) != 0 && lua::documented(L, index).owner != nullptr;
}

/// A Lua function that reads a field of an object of dinal, so that no user code runs.
int field(lua_State* L) {
    lua_gettable(L, 1);
    return 1;
}

std::vector<std::string> variables(lua_State* L, lua_Debug* frame) {
    std::vector<std::string> names;
    each_variable(L, frame, [&names](std::string_view name) {
        if (!name.empty() && name.front() != '(' && name != "_ENV") {
            names.emplace_back(name);
        }
    });
    return names;
}

/// The beginning of x.y.z, whose last name is the token `last`.
std::size_t path_begin(const lua::Tokens& all, std::size_t last) {
    while (last >= 2 && all[last - 1].is(".") && all[last - 2].kind == lua::TokenKind::name) last -= 2;
    return last;
}

/// Pushes the value of x.y.z, whose last name is the token `last`; runs no user code.
void push_path(lua_State* L, lua_Debug* frame, const lua::Tokens& all, std::size_t last) {
    const std::size_t first = path_begin(all, last);
    push_variable(L, frame, all[first].text);
    for (std::size_t k = first + 2; k <= last; k += 2) {
        lua_pushlstring(L, all[k].text.data(), all[k].text.size());
        go_to_field(L);
    }
}

/// For "x.y.name" or "x.y:name" in the statement: the names of x.y.
std::vector<std::string> siblings(lua_State* L, lua_Debug* frame, std::string_view name, std::string_view statement) {
    const lua::Tokens all = lua::tokens(statement);
    for (std::size_t i = 2; i < all.size(); ++i) {
        const bool is_part = all[i].is(name) && (all[i - 1].is(".") || all[i - 1].is(":"));
        if (!is_part || all[i - 2].kind != lua::TokenKind::name) continue;
        push_path(L, frame, all, i - 2);
        std::vector<std::string> names = member_names(L);
        lua_pop(L, 1);
        return names;
    }
    return {};
}

/// Returns whether the statement itself declares the name: local x, function(x), for x, { x = 1 }.
bool is_declared(const lua::Tokens& all, std::string_view name) {
    bool declaring = false;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const lua::Token& token = all[i];
        declaring = token.is("local") || token.is("for") || token.is("function") ||
                    (declaring && (token.kind == lua::TokenKind::name || token.is(",") || token.is("(")));
        const bool assigned = i + 1 < all.size() && all[i + 1].is("=");
        if (token.kind == lua::TokenKind::name && token.text == name && (declaring || assigned)) {
            return true;
        }
    }
    return false;
}

/// Returns whether a function on the call stack has a variable of this name. The statement may contain several
/// functions, as sys:simulate{ M = function(t) error "no" end } does.
bool is_variable(lua_State* L, lua_Debug* frame, std::string_view name) {
    constexpr int most_levels = 50;
    const auto knows = [&](lua_Debug* of) {
        const std::vector<std::string> names = variables(L, of);
        return text::contains(names, name);
    };
    if (knows(frame)) return true;
    lua_Debug caller{};
    for (int level = 0; level < most_levels && lua_getstack(L, level, &caller) != 0; ++level) {
        if (knows(&caller)) return true;
    }
    return false;
}

/// Returns whether the token is a global that is nil and that the statement does not declare.
bool is_nil_global(lua_State* L, lua_Debug* frame, const lua::Tokens& all, std::size_t i) {
    const bool field = i > 0 && (all[i - 1].is(".") || all[i - 1].is(":") || all[i - 1].is("goto"));
    if (all[i].kind != lua::TokenKind::name || field || is_declared(all, all[i].text)) return false;
    if (is_variable(L, frame, all[i].text)) return false;
    const bool is_nil = lua::push_global(L, all[i].text) == LUA_TNIL;
    lua_pop(L, 1);
    return is_nil;
}

/// Advice about a global in the statement that is nil: with an option, the value given for it, `option = x`; otherwise
/// one with a similar known name, or any one with `any`.
Advice nil_global(lua_State* L, lua_Debug* frame, std::string_view statement, std::string_view option, bool any) {
    const lua::Tokens all = lua::tokens(statement);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (!is_nil_global(L, frame, all, i)) continue;
        const std::string hint = similar_global(L, all[i].text);
        const bool its_value = i > 1 && all[i - 1].is("=") && all[i - 2].is(option);
        if (option.empty() ? any || !hint.empty() : its_value) {
            return {fmt::format("; '{}' is nil{}", all[i].text, hint), std::string(all[i].text)};
        }
    }
    return {};
}

/// The use of a name: 2*rad needs a number, which math.rad is not.
enum class Use { any, as_number };

/// Library functions with that name: sin is math.sin, rk4 is integrator.rk4. Two at most.
std::string qualified(lua_State* L, std::string_view name, Use use) {
    constexpr std::array<std::string_view, 8> modules = {"excitation", "integrator", "theory", "vector",
                                                         "math",       "string",     "table",  "os"};
    std::vector<std::string> found;
    const int top = lua_gettop(L);
    for (const std::string_view module : modules) {
        if (lua::push_global(L, module) == LUA_TTABLE) {
            lua_pushlstring(L, name.data(), name.size());
            go_to_field(L);
            const bool calls = use == Use::as_number && lua_isfunction(L, -1);
            if (!lua_isnil(L, -1)) found.push_back(fmt::format("{}.{}{}", module, name, calls ? "(...)" : ""));
        }
        lua_settop(L, top);
    }
    return text::did_you_mean_one_of(found);
}

/// Returns whether the value on the top is an object of dinal with this field or method, such as a system or a run.
bool has_member(lua_State* L, std::string_view name, lua::Kind kind) {
    const lua::Documented found = lua::documented(L, -1);
    return is_object_of_ours(L, -1) && found.member == nullptr &&
           std::ranges::any_of(found.owner->members,
                               [&](const lua::Member& member) { return member.kind == kind && member.name == name; });
}

/// Fields with that name in the user's variables: Rd is dry.Rd. Two at most.
std::string field_of_variable(lua_State* L, std::string_view name) {
    std::vector<std::string> owners;
    lua_pushglobaltable(L);
    lua_pushnil(L);
    while (lua_next(L, -2) != 0) {
        const bool named = lua_type(L, -2) == LUA_TSTRING;
        if (named && has_member(L, name, lua::Kind::field) && std::string_view(lua_tostring(L, -2)) != "ans") {
            owners.push_back(fmt::format("{}.{}", lua_tostring(L, -2), name));
        }
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    std::ranges::sort(owners);
    return text::did_you_mean_one_of(owners);
}

/// The likely meanings of an undefined name, among these variables and the globals.
std::string meant_by(lua_State* L, std::string_view name, std::vector<std::string> names, Use use = Use::any) {
    std::string hint = foreign_tokens(name, Seen::unknown);
    hint = hint.empty() ? qualified(L, name, use) : hint;
    hint = hint.empty() ? field_of_variable(L, name) : hint;
    lua_pushglobaltable(L);
    add_keys(L, names);
    lua_pop(L, 1);
    return hint.empty() ? text::did_you_mean(name, names, text::Likeness::of_letters) : hint;
}

}  // namespace

void push_variable(lua_State* L, lua_Debug* frame, std::string_view wanted) {
    lua_pushnil(L);
    const int result = lua_gettop(L);
    bool found = false;
    each_variable(L, frame, [&](std::string_view name) {
        if (name == wanted) {
            lua_copy(L, -1, result);
            found = true;
        }
    });
    if (!found) {
        lua::push_global(L, wanted);
        lua_replace(L, result);
    }
}

void go_to_field(lua_State* L) {
    const int value = lua_gettop(L) - 1, key = value + 1;
    bool found = false;
    if (is_object_of_ours(L, value)) {
        lua_pushcfunction(L, field);
        lua_pushvalue(L, value);
        lua_pushvalue(L, key);
        found = lua_pcall(L, 2, 1, 0) == LUA_OK;
    } else {
        lua_pushvalue(L, value);
        for (int i = 0; i < most_metatables && !found; ++i) {
            if (lua_istable(L, -1)) {
                lua_pushvalue(L, key);
                found = lua_rawget(L, -2) != LUA_TNIL;
                if (!found) lua_pop(L, 1);
            }
            if (!found && !step_to_index_table(L)) break;
        }
    }
    if (!found) lua_pushnil(L);
    lua_replace(L, value);
    lua_settop(L, value);
}

std::vector<std::string> member_names(lua_State* L) {
    std::vector<std::string> names;
    luaL_checkstack(L, LUA_MINSTACK, "for the names of members");
    const int top = lua_gettop(L);
    lua_pushvalue(L, -1);
    if (const lua::Documented found = lua::documented(L, -1); found.owner != nullptr && found.member == nullptr) {
        for (const lua::Member& member : found.owner->members) {
            if (member.kind != lua::Kind::metamethod) {
                names.emplace_back(member.name);
            }
        }
    }
    for (int i = 0; i < most_metatables; ++i) {
        if (lua_istable(L, -1)) {
            add_keys(L, names);
        }
        if (lua_isuserdata(L, -1) != 0 || !step_to_index_table(L)) {
            break;
        }
    }
    lua_settop(L, top);
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

std::string similar_global(lua_State* L, std::string_view name) {
    return meant_by(L, name, {});
}

std::string nil_value(lua_State* L, lua_Debug* frame, std::string_view text, bool assignments) {
    luaL_checkstack(L, LUA_MINSTACK, "for the values of options");
    const lua::Tokens all = lua::tokens(text);
    int braces = 0;
    for (std::size_t i = 2; i < all.size(); ++i) {
        braces += all[i - 2].is("{") ? 1 : all[i - 2].is("}") ? -1 : 0;
        assignments = assignments && !all[i].is("function");  // a function may use the variable later
        const bool option = braces > 0, field = option && i + 3 < all.size() && all[i + 1].is(".");
        const std::size_t next = i + (field ? 3 : 1);
        const bool ends = next == all.size() || all[next].is(",") || all[next].is("}") || all[next].is(";") ||
                          (!option && all[next].line > all[i].line);
        if (!all[i - 1].is("=") || all[i].kind != lua::TokenKind::name || !ends || !(option || assignments)) continue;
        std::string whole_name(all[i].text), hint;
        if (field) {
            push_variable(L, frame, all[i].text);
            const std::vector<std::string> names = lua_istable(L, -1) ? member_names(L) : std::vector<std::string>();
            lua_pop(L, 1);
            whole_name.append(".").append(all[i + 2].text);
            hint = text::did_you_mean(all[i + 2].text, names);
            if (hint.empty() || text::contains(names, all[i + 2].text)) continue;
        } else if (is_nil_global(L, frame, all, i)) {
            hint = similar_global(L, all[i].text);
        } else {
            continue;
        }
        if (option) return fmt::format("'{}' is nil, so {} is not given{}", whole_name, all[i - 2].text, hint);
        return hint.empty() ? "" : fmt::format("'{}' is nil{}", whole_name, hint);
    }
    return "";
}

Advice advice_on(lua_State* L, lua_Debug* frame, const text::Error& error, std::string_view statement) {
    luaL_checkstack(L, LUA_MINSTACK, "for the help with an error");
    if (!error.cure.empty()) {
        return {};
    }
    if (std::string habit = running_habit(error, statement); !habit.empty()) {
        return {habit};
    }
    if (!error.instead.empty()) return {error.instead};
    const bool is_nil = error.culprit == "nil";
    return nil_global(L, frame, statement, is_nil ? error.option : "", is_nil);
}

Advice advice_on(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement) {
    luaL_checkstack(L, LUA_MINSTACK, "for the help with an error");
    for (const std::string& habit : {running_habit(L, message, statement), meant_method(L, message, statement)}) {
        if (!habit.empty()) {
            return {habit};
        }
    }
    if (Advice missing = missing_element(L, frame, message, statement); !missing.culprit.empty()) return missing;
    if (message.type == "nil" && message.kind == "global") {
        return {meant_by(L, message.name, variables(L, frame), message.calculates ? Use::as_number : Use::any)};
    }
    if (message.type == "nil" && (message.kind == "field" || message.kind == "method")) {
        return {text::did_you_mean(message.name, siblings(L, frame, message.name, statement))};
    }
    return nil_global(L, frame, statement, "", message.misses_a_value);
}

namespace {

/// The call name(object, ...) in the statement as one of a method: "object:name(...)". Empty without such a call, or if
/// its first argument is a string, as in save("run.mat").
std::string as_method(std::string_view statement, std::string_view name) {
    const lua::Tokens all = lua::tokens(statement);
    std::size_t i = 2;
    while (i < all.size() && !(all[i - 2].is(name) && all[i - 1].is("("))) ++i;
    if (i >= all.size() || all[i].is(")") || all[i].kind == lua::TokenKind::string) return "";
    const std::size_t begin = all[i].at;
    bool simple = all[i].nesting() == 0;  // a name, field or call, which a colon may follow
    for (int depth = 0; i < all.size() && (depth > 0 || !(all[i].is(",") || all[i].is(")"))); ++i) {
        const bool path = all[i].kind == lua::TokenKind::name || all[i].is(".") || all[i].is(":");
        simple = simple && (depth > 0 || path || all[i].nesting() > 0);
        depth += all[i].nesting();
    }
    if (i == all.size()) return "";
    const std::string_view object = text::trimmed(statement.substr(begin, all[i].at - begin), " \n");
    constexpr std::size_t longest = 40;
    if (object.size() > longest || object.find('\n') != std::string_view::npos) return fmt::format("x:{}(...)", name);
    return fmt::format("{}:{}({})", simple ? std::string(object) : fmt::format("({})", object), name,
                       all[i].is(")") ? "" : "...");
}

/// Returns whether an object among the arguments of the innermost calls has a method of that name.
bool passes_its_owner(lua_State* L, std::string_view name) {
    constexpr int innermost = 4;
    lua_Debug frame{};
    for (int level = 0; level < innermost && lua_getstack(L, level, &frame) != 0; ++level) {
        for (int i = 1; const char* variable = lua_getlocal(L, &frame, i); ++i) {
            const bool passed = *variable == '(' && has_member(L, name, lua::Kind::method);
            lua_pop(L, 1);
            if (passed) return true;
        }
    }
    return false;
}

/// A Lua function that returns the length of an object of dinal, so that no user code runs.
int length(lua_State* L) {
    lua_pushinteger(L, luaL_len(L, 1));
    return 1;
}

/// The length of the list on the top, which is popped; none if it is not a list.
std::optional<lua_Integer> taken_length(lua_State* L) {
    std::optional<lua_Integer> count;
    if (lua_istable(L, -1)) {
        count = static_cast<lua_Integer>(lua_rawlen(L, -1));
    } else if (is_object_of_ours(L, -1)) {
        lua_pushcfunction(L, length);
        lua_pushvalue(L, -2);
        if (lua_pcall(L, 1, 1, 0) == LUA_OK) count = lua_tointeger(L, -1);
        lua_pop(L, 1);
    }
    lua_pop(L, 1);
    return count;
}

/// The whole number in a token, or in the variable that it names.
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
    const std::string meant = name.empty() ? "" : as_method(statement, name);
    if (meant.empty() || !passes_its_owner(L, name)) return "";
    return fmt::format("; did you mean '{}'?", meant);
}

Advice missing_element(lua_State* L, lua_Debug* frame, const lua::LuaMessage& message, std::string_view statement) {
    // Lua 5.4.4 says 'integer index', later versions '?'.
    if (message.type != "nil" || message.kind != "field" || (message.name != "integer index" && message.name != "?")) {
        return {};
    }
    Advice possible;
    const lua::Tokens all = lua::tokens(statement);
    for (std::size_t i = 1; i + 1 < all.size(); ++i) {
        if (!all[i].is("[") || all[i - 1].kind != lua::TokenKind::name) continue;
        push_path(L, frame, all, i - 1);
        const auto count = taken_length(L);
        if (!count) continue;
        const lua::Token& index = all[i + 1];
        const bool alone = i + 2 < all.size() && all[i + 2].is("]");
        const auto number = alone ? number_of(L, frame, index) : std::nullopt;
        if (number && *number >= 1 && *number <= *count) continue;  // the element exists
        const std::size_t begin = all[path_begin(all, i - 1)].at;
        Advice found{fmt::format("; '{}' has {}", statement.substr(begin, all[i].at - begin),
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
