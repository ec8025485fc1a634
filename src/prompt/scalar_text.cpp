#include "prompt/scalar_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "help/signature.hpp"
#include "lua/bind.hpp"
#include "lua/interrupt.hpp"
#include "lua/lua_text.hpp"
#include "source/function_source.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
namespace {

constexpr std::size_t longest_string = 1000;
constexpr std::size_t longest_inner_string = 60;
constexpr std::size_t longest_text = 4000;  // a text of several lines, as from run:explain(), is shown as it is
constexpr int most_source_lines = 12;       // of a function

int by_tostring(lua_State* L) {
    luaL_tolstring(L, 1, nullptr);
    return 1;
}

/// What tostring says, or that it failed.
std::string told(lua_State* L, int index) {
    lua_pushvalue(L, index);
    lua_pushcfunction(L, by_tostring);
    lua_insert(L, -2);
    const bool fine = lua_pcall(L, 1, 1, 0) == LUA_OK;
    if (!fine && lua::interrupt_requested()) {
        lua::raise_interrupted(L);
    }
    const std::string text(lua_isstring(L, -1) != 0 ? lua::text_at(L, -1) : luaL_typename(L, -1));
    lua_pop(L, 1);
    return fine ? text : fmt::format("<error in __tostring: {}>", text);
}

/// Several lines of nothing but printable characters, too long to be read in quotes.
bool is_text(std::string_view text, const terminal::Display& screen) {
    const bool is_long = text.find('\n') != std::string_view::npos && text.size() > screen.width;
    return is_long && text.size() <= longest_text && text::is_printable(text);
}

std::string string_text(lua_State* L, int index, Place place, const terminal::Display& screen) {
    const std::string_view string = lua::text_at(L, index);
    if (place == Place::alone && is_text(string, screen)) {
        return text::wrapped(terminal::spelled(string, screen), screen.width - 1);
    }
    const std::size_t limit = place == Place::inside ? longest_inner_string : longest_string;
    std::string text = text::quoted(string, limit, screen.unicode);
    return place == Place::alone && string.size() > limit ? fmt::format("{} ({} bytes)", text, string.size()) : text;
}

/// A function as its source where that is short, else where it is defined; ours as they are called.
std::string function_text(lua_State* L, int index, const terminal::Display& screen) {
    if (const lua::Documented found = lua::documented(L, index); found.member != nullptr) {
        return text::wrapped(fmt::format("function {}", help::signature(found.member->doc)), screen.width - 1);
    }
    const auto source = source::function_source(L, index);
    if (lua_iscfunction(L, index) != 0) {
        return source ? fmt::format("function {} of Lua", *source) : "function written in C";
    }
    lua_Debug about{};
    lua_pushvalue(L, index);
    lua_getinfo(L, ">S", &about);
    if (source && std::count(source->begin(), source->end(), '\n') < most_source_lines) {
        return *source;
    }
    return fmt::format("function at {}:{}", about.short_src, about.linedefined);
}

std::string in_one_line(const std::string& text) {
    const std::size_t end = text.find('\n');
    return end == std::string::npos ? text : text.substr(0, end) + "...";
}

}  // namespace

bool is_plain_table(lua_State* L, int index) {
    if (!lua_istable(L, index)) {
        return false;
    }
    if (luaL_getmetafield(L, index, "__tostring") == LUA_TNIL) {
        return true;
    }
    lua_pop(L, 1);
    return false;
}

std::string scalar_text(lua_State* L, int index, Place place, const terminal::Display& screen) {
    switch (lua_type(L, index)) {
        case LUA_TNUMBER:
            return std::isnan(lua_tonumber(L, index)) ? "nan" : told(L, index);
        case LUA_TSTRING:
            return string_text(L, index, place, screen);
        case LUA_TFUNCTION:
            return place == Place::inside ? "function" : function_text(L, index, screen);
        default:
            break;
    }
    const lua::Documented found = lua::documented(L, index);
    if (place == Place::inside) {
        return terminal::spelled(in_one_line(told(L, index)), screen);
    }
    if (found.owner != nullptr && found.owner->card != nullptr) {
        return found.owner->card(L, lua_absindex(L, index), screen);
    }
    std::string text = told(L, index);
    return found.owner != nullptr ? text::wrapped(terminal::spelled(text, screen), screen.width - 1) : text;
}

}  // namespace dinal::prompt
