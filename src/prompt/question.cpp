#include "prompt/question.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "help/help_text.hpp"
#include "help/tour.hpp"
#include "lua/tokens.hpp"
#include "prompt/call.hpp"
#include "prompt/meaning.hpp"
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
    say(fmt::format("{}, now {}\n", luaL_typename(L, 1), show(L, 1, screen)));
    return 0;
}

}  // namespace

bool is_question(std::string_view line) {
    const std::vector<lua::Token> all = lua::tokens(line);
    return line.find('\n') == std::string_view::npos && !all.empty() && (all.front().is("?") || all.back().is("?"));
}

void answer_question(lua_State* L, std::string_view line) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::string_view words = text::trimmed(line, " ?\"'", " ?\"'(){}");
    if (words.empty()) {
        say(help::tour_page(1));
        return;
    }
    const int top = lua_gettop(L);
    const std::vector<lua::Token> all = lua::tokens(words);
    const Meaning found = meaning(L, all);
    if (const std::string text = entry(found, screen); !text.empty()) {
        say(text);
    } else if (const std::vector<std::string> names = help::help_names();
               found.kind == Meaning::Kind::value && std::find(names.begin(), names.end(), words) == names.end()) {
        if (call_with(L, show_value) != LUA_OK) {
            say_error(take_text(L));
        }
    } else {
        say(help::help_about(words, screen));
    }
    lua_settop(L, top);
}

}  // namespace dinal::prompt
