#include "source/value_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "lua/bind.hpp"
#include "lua/standard_globals.hpp"
#include "lua/user_function.hpp"
#include "lua/vector.hpp"
#include "motion/integrators.hpp"
#include "source/describe.hpp"
#include "source/function_source.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::source {

namespace {

constexpr std::size_t deepest = 50;  // nesting depth of tables and functions, which use the C++ stack

}  // namespace

std::string ValueText::nothing(std::string_view what) {
    remarks_.push_back(fmt::format("-- {} could not be written down", what));
    return "nil";
}

std::string ValueText::expression(int index) {
    luaL_checkstack(L_, 10, "too deep");
    index = lua_absindex(L_, index);
    if (--budget_ < 0) {
        return budget_ == -1 ? nothing("a part of a large table") : "nil";
    }
    switch (lua_type(L_, index)) {
        case LUA_TNIL:
            return "nil";
        case LUA_TBOOLEAN:
            return lua_toboolean(L_, index) != 0 ? "true" : "false";
        case LUA_TNUMBER:
            return lua_isinteger(L_, index) != 0 ? fmt::format("{}", lua_tointeger(L_, index))
                                                 : lua::float_text(lua_tonumber(L_, index));
        case LUA_TSTRING:
            return text::quoted(lua::text_at(L_, index));
        case LUA_TTABLE:
            return table(index);
        case LUA_TFUNCTION:
            return function(index);
        case LUA_TUSERDATA:
            return object(index);
        default:
            return nothing(lua::describe(L_, index));
    }
}

std::string ValueText::table(int index) {
    const void* identity = lua_topointer(L_, index);
    if (text::contains(open_, identity) || open_.size() > deepest) {
        return nothing("a table that contains itself");
    }
    const int top = lua_gettop(L_);
    // The metatable of rows of data and balances only stores the order of names.
    if (lua_getmetatable(L_, index) != 0 && luaL_getmetafield(L_, index, "names") == LUA_TNIL) {
        remarks_.emplace_back("-- the metatable of a table could not be written down");
    }
    lua_settop(L_, top);
    open_.push_back(identity);
    std::string text;
    const auto sequence = static_cast<lua_Integer>(lua_rawlen(L_, index));
    for (lua_Integer i = 1; i <= sequence && budget_ >= 0; ++i) {
        lua_rawgeti(L_, index, i);
        text += (text.empty() ? "" : ", ") + expression(-1);
        lua_pop(L_, 1);
    }
    std::vector<std::string> named;
    lua_pushnil(L_);
    while (budget_ >= 0 && lua_next(L_, index) != 0) {
        const bool listed =
            lua_isinteger(L_, -2) != 0 && lua_tointeger(L_, -2) >= 1 && lua_tointeger(L_, -2) <= sequence;
        if (!listed) {
            const bool plain = lua_type(L_, -2) == LUA_TSTRING && lua::is_name(lua_tostring(L_, -2));
            const std::string key = plain ? lua_tostring(L_, -2) : "[" + expression(-2) + "]";
            named.push_back(key + " = " + expression(-1));
        }
        lua_pop(L_, 1);
    }
    std::ranges::sort(named);  // the same text in each process
    for (const std::string& entry : named) text += (text.empty() ? "" : ", ") + entry;
    lua_settop(L_, top);  // the loop may end early
    open_.pop_back();
    return text.empty() ? "{}" : "{ " + text + " }";
}

std::string ValueText::object(int index) {
    if (const auto* vector = lua::test<lua::Vector>(L_, index)) {
        if (aside_) return aside_(index);
        budget_ -= static_cast<int>(std::min<std::size_t>(vector->size(), 1'000'000));
        if (budget_ < 0) {
            return nothing("a long vector");
        }
        std::string text;
        for (const double x : vector->values()) {
            text += (text.empty() ? "" : ", ") + lua::float_text(x);
        }
        return "vector{ " + text + " }";
    }
    const auto text = [this](const auto* own) { return own != nullptr ? lua_text(L_, *own, this) : ""; };
    std::string own = text(lua::test<model::Friction>(L_, index)) + text(lua::test<model::Spring>(L_, index));
    if (const auto* rig = lua::test<model::SystemHandle>(L_, index)) own = lua_text(L_, **rig, this);
    if (const auto* excitation = lua::test<model::Excitation>(L_, index)) own = describe(L_, *excitation, this);
    if (const auto* method = lua::test<motion::Integrator>(L_, index)) own = lua_text(*method);
    if (!own.empty()) return own;
    if (aside_ && lua::documented(L_, index).owner != nullptr) own = aside_(index);
    if (!own.empty()) return own;
    return nothing(lua::describe(L_, index));
}

std::optional<std::string> ValueText::aside(const std::vector<double>& numbers) {
    if (!aside_) return std::nullopt;
    lua::push_vector(L_, numbers);
    std::string name = aside_(lua_gettop(L_));
    lua_pop(L_, 1);
    return name;
}

std::string ValueText::function(int index) {
    const void* identity = lua_topointer(L_, index);
    if (text::contains(open_, identity)) {
        return nothing("a function that refers to itself in a roundabout way");
    }
    if (open_.size() > deepest) {
        return nothing("a function within too many others");
    }
    const auto source = function_source(L_, index);
    if (!source) {
        const lua::Foreign* other = lua::foreign(L_, index);
        if (aside_ && other != nullptr) return aside_(index);
        return nothing(other != nullptr ? fmt::format("a function written in {}", other->language)
                                        : "a function whose text is not at hand");
    }
    if (lua_iscfunction(L_, index) != 0) {
        return *source;
    }
    open_.push_back(identity);
    note_globals(index, *source);
    std::string text = with_locals(index, *source);
    open_.pop_back();
    return text;
}

/// (function() local a = 1; return function(t) return a*t end end)() for a function with upvalues.
std::string ValueText::with_locals(int index, const std::string& source) {
    std::string locals;
    std::string own_name;  // in local function f(t) ... f(t - 1) ... end, f is an upvalue of f
    for (int i = 1; const char* name = lua_getupvalue(L_, index, i); ++i) {
        const bool environment = std::string_view(name) == "_ENV";
        if (lua_rawequal(L_, -1, index) != 0) {
            own_name = name;
        } else if (!environment && *name != '\0') {
            locals += fmt::format("local {} = {}\n", name, expression(-1));
        }
        lua_pop(L_, 1);
    }
    if (locals.empty() && own_name.empty()) {
        return source;
    }
    const std::string result =
        own_name.empty() ? "return " + source : fmt::format("local {0}; {0} = {1}\nreturn {0}", own_name, source);
    return "(function()\n" + locals + result + "\nend)()";
}

void ValueText::note_globals(int function_index, std::string_view source) {
    for (int i = 1; const char* name = lua_getupvalue(L_, function_index, i); ++i) {
        if (std::string_view(name) == "_ENV" && lua_istable(L_, -1)) {
            const int environment = lua_gettop(L_);
            for (const std::string& free : lua::free_names(source)) {
                note_global(environment, free);
            }
        }
        lua_pop(L_, 1);
    }
}

void ValueText::note_global(int environment, const std::string& name) {
    if (text::contains(names_, name)) {
        return;
    }
    lua::push_standard_globals(L_);
    lua_pushlstring(L_, name.data(), name.size());
    lua_pushvalue(L_, -1);
    lua_rawget(L_, environment);
    lua_insert(L_, -2);
    lua_rawget(L_, -3);  // stack: standard globals, value, standard value
    const bool users = !lua_isnil(L_, -2) && lua_rawequal(L_, -1, -2) == 0;
    lua_pop(L_, 1);
    if (users) {
        names_.push_back(name);
        const bool itself = text::contains(open_, lua_topointer(L_, -1));
        // function M(t) return M_old(t) end needs M_old first; a function that calls itself already exists under its
        // name, if it has one.
        if (itself && aside_) nothing("the global function " + name + ", which calls itself: make it local");
        globals_.push_back(name + " = " + (itself ? "nil" : expression(-1)));
    }
    lua_pop(L_, 2);
}

}  // namespace dinal::source
