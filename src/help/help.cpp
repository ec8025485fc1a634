// help(x), at the prompt and in scripts.
#include "help/help.hpp"

#include <unistd.h>

#include "help/help_text.hpp"
#include "help/library.hpp"
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

std::string text_about_value(lua_State* L, const terminal::Display& screen) {
    if (lua_isnone(L, 1)) {
        return tour_page(1);
    }
    if (lua_isnil(L, 1)) {
        // help(nothing_of_that_name) comes here.
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
    return lua::describe(L, 1) + " has no help of its own; put the name in quotes: help \"omega0\"" +
           (lua_isfunction(L, 1) ? ", or see https://www.lua.org/manual/5.4 for Lua's own functions" : "") + "\n";
}

int help(lua_State* L) {
    const std::string text = text_about_value(L, terminal::display_of(STDOUT_FILENO));
    terminal::show_in_pages(text);
    return 0;
}

constexpr lua::Member functions[] = {
    {lua::a_function<help>,
     {"help(x) or help \"words\"",
      "Prints what x is and how it is used: a function, a method, a module, an object, or a name in quotes; words that "
      "are no name are searched for in all names and descriptions. help() alone shows where to begin.",
      "help(excitation.step)\nhelp \"dead zone\""}},
};

}  // namespace

const lua::Class help_functions = {
    "help", {"help(x) or help \"words\"", "The manual at the prompt.", "help \"dead zone\""}, functions};

void register_help(lua_State* L) {
    lua::add_functions(L, help_functions);
}

}  // namespace dinal::help
