#include "prompt/question.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "help/help_text.hpp"
#include "help/lua_words.hpp"
#include "help/tour.hpp"
#include "lua/standard_globals.hpp"
#include "lua/tokens.hpp"
#include "prompt/call.hpp"
#include "prompt/completion.hpp"
#include "prompt/output.hpp"
#include "prompt/printer.hpp"
#include "terminal/display.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

/// Pushes nothing. The entry for what the words are, if they are an expression of the user's that we know.
std::string entry(const Meaning& meaning, const terminal::Display& screen) {
    if (meaning.kind == Meaning::Kind::member && meaning.section != nullptr) {
        return help::member_text(*meaning.section, *meaning.member, screen);
    }
    return meaning.kind == Meaning::Kind::object && meaning.section != nullptr
               ? help::class_text(*meaning.section, screen)
               : "";
}

int show_value(lua_State* L) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    return lua::push_text(L, fmt::format("{}, now {}\n", luaL_typename(L, 1), show(L, 1, screen)));
}

}  // namespace

bool is_question(std::string_view line) {
    const std::vector<lua::Token> all = lua::tokens(line);
    return line.find('\n') == std::string_view::npos && !all.empty() && (all.front().is("?") || all.back().is("?"));
}

std::string answer_to(lua_State* L, std::string_view line) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::string_view words = text::trimmed(line, " ?\"'", " ?\"'(){}");
    if (words.empty()) {
        return help::tour_page(1);
    }
    const std::vector<std::string> own = lua::users_globals(L);
    if (!help::lua_word(words).empty() && std::find(own.begin(), own.end(), words) == own.end()) {
        return help::help_about(words, screen);
    }
    const int top = lua_gettop(L);
    const std::vector<lua::Token> all = lua::tokens(words);
    const Meaning found = meaning(L, all);
    std::string answer = entry(found, screen);
    if (const std::vector<std::string> names = help::help_names();
        answer.empty() && found.kind == Meaning::Kind::value &&
        std::find(names.begin(), names.end(), words) == names.end()) {
        lua_pushcfunction(L, show_value);
        lua_insert(L, -2);
        const bool shown = call(L, 1, 1) == LUA_OK;
        answer = take_text(L) + (shown ? "" : "\n");
    }
    lua_settop(L, top);
    return answer.empty() ? help::help_about(words, screen) : answer;
}

}  // namespace dinal::prompt
