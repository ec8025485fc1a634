// help(x), at the prompt and in scripts.
#include "lua/bind.hpp"
#include "lua/dinal_table.hpp"
#include "lua/library.hpp"
#include "lua/manual.hpp"

namespace dinal {

namespace {

std::string text_about(const Documented& found) {
    std::string text;
    for (const Section& section : sections()) {
        if (section.description == found.owner) {
            text += found.member != nullptr ? member_text(section, *found.member) : class_text(section);
        }
    }
    return text;
}

std::string text_about_value(lua_State* L) {
    if (lua_isnoneornil(L, 1)) {
        // help(nothing_of_that_name) comes here, too.
        return lua_isnone(L, 1) ? start_page() : "nil has no help; put the name in quotes: help \"simulate\"\n";
    }
    if (lua_type(L, 1) == LUA_TSTRING) {
        return help_about(lua_tostring(L, 1));
    }
    push_dinal_table(L);
    const bool is_library = lua_rawequal(L, 1, -1) != 0;
    lua_pop(L, 1);
    if (is_library) {
        return start_page();
    }
    if (const Documented found = documented(L, 1); found.owner != nullptr) {
        return text_about(found);
    }
    return describe(L, 1) + " has no help of its own; put the name in quotes: help \"omega0\"" +
           (lua_isfunction(L, 1) ? ", or see https://www.lua.org/manual/5.4 for Lua's own functions" : "") + "\n";
}

int help(lua_State* L) {
    const std::string text = text_about_value(L);
    lua_writestring(text.data(), text.size());  // as print() does
    return 0;
}

constexpr Member functions[] = {
    {"help",
     guarded<help>,
     Kind::function,
     {"help(x) or help \"words\"",
      "Prints what x is and how it is used: a function, a method, a module, an object, or a name in quotes; words that "
      "are no name are searched for in all names and descriptions. help() alone shows where to begin.",
      "help(excitation.step)\nhelp \"dead zone\""}},
};

}  // namespace

const Class help_functions = {
    "help", {"help(x) or help \"words\"", "The manual at the prompt.", "help \"dead zone\""}, functions};

void register_help(lua_State* L) {
    add_functions(L, help_functions);
}

}  // namespace dinal
