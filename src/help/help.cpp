// help(x), at the prompt and in scripts.
#include "help/help.hpp"

#include <unistd.h>

#include <algorithm>

#include "help/help_text.hpp"
#include "help/library.hpp"
#include "help/lua_words.hpp"
#include "help/tour.hpp"
#include "lua/bind.hpp"
#include "lua/standard_globals.hpp"
#include "terminal/pager.hpp"

namespace dinal::help {

namespace {

std::string text_about(const lua::Documented& found, const terminal::Display& screen) {
    std::string text;
    for (const Section& section : sections()) {
        if (section.description == found.owner) {
            text += found.member != nullptr ? member_text(section, *found.member, screen) : class_text(section, screen);
        }
    }
    return text;
}

std::string text_about_page(lua_State* L) {
    const lua_Integer page = lua_tointeger(L, 1);
    const auto last = static_cast<lua_Integer>(tour_pages());
    return page >= 1 && page <= last ? tour_page(static_cast<std::size_t>(page))
                                     : "the tour has pages 1 to " + std::to_string(last) + "\n";
}

/// "math.sin" for that Lua function, "" for other values.
std::string name_in_lua(lua_State* L, int index) {
    for (const std::string_view word : lua_words()) {
        const int top = lua_gettop(L);
        const std::size_t dot = word.find('.');
        lua_pushglobaltable(L);
        lua_pushlstring(L, word.data(), std::min(dot, word.size()));
        lua_rawget(L, -2);
        if (dot != std::string_view::npos && lua_istable(L, -1)) {
            lua_pushlstring(L, word.data() + dot + 1, word.size() - dot - 1);
            lua_rawget(L, -2);
        }
        const bool same = !lua_isnil(L, -1) && lua_rawequal(L, index, -1) != 0;
        lua_settop(L, top);
        if (same) return std::string(word);
    }
    return "";
}

std::string text_about_value(lua_State* L, const terminal::Display& screen) {
    if (lua_isnone(L, 1)) {
        return tour_page(1);
    }
    if (lua_isnil(L, 1)) {
        // help(undefined_name) also arrives here.
        return "nil has no help; put the name in quotes: help \"simulate\"\n";
    }
    if (lua_type(L, 1) == LUA_TSTRING) {
        const std::string_view words = lua_tostring(L, 1);
        return words.find_first_not_of(' ') == std::string_view::npos ? tour_page(1) : help_about(words, screen);
    }
    if (lua_isinteger(L, 1) != 0) {
        return text_about_page(L);
    }
    lua::push_dinal_table(L);
    const bool is_library = lua_rawequal(L, 1, -1) != 0;
    lua_pop(L, 1);
    if (is_library) {
        return help_about("contents", screen);
    }
    if (const lua::Documented found = lua::documented(L, 1); found.owner != nullptr) {
        return text_about(found, screen);
    }
    if (const std::string name = name_in_lua(L, 1); !lua_word(name).empty()) {
        return lua_word(name);
    }
    return lua::describe(L, 1) + " has no help of its own; put the name in quotes: help \"omega0\"\n";
}

int help(lua_State* L) {
    const std::string text = text_about_value(L, terminal::display_of(STDOUT_FILENO));
    terminal::show_in_pages(text);
    return 0;
}

constexpr lua::Member functions[] = {
    {lua::a_function<help>,
     {"help(x) or help \"words\"",
      "Explains a function, method, module or object, or a name in quotes. Other words are searched for in all "
      "names and descriptions. help() starts a tour.",
      "help(excitation.step)\nhelp \"dead zone\""}},
};

}  // namespace

const lua::Class help_functions = {
    "help", {"help(x) or help \"words\"", "The manual at the prompt.", "help \"dead zone\""}, functions};

void register_help(lua_State* L) {
    lua::add_functions(L, help_functions);
}

}  // namespace dinal::help
