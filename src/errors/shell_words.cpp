#include "errors/shell_words.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "lua/safe_mode.hpp"
#include "lua/tokens.hpp"
#include "text/words.hpp"

namespace dinal::errors {
namespace {

using Row = std::pair<std::string_view, std::string_view>;

constexpr std::string_view shell_is_elsewhere =
    "no shell is in here; in a terminal Ctrl-Z leads to it, and fg comes back";

constexpr std::array<Row, 9> words_and_cures = {{
    {"exit quit q bye logout ende beenden salir quitter esci", ":quit or Ctrl-D leaves"},
    {"clear cls clc", "Ctrl-L clears the screen, :reset forgets your variables"},
    {"who whos", ":who lists your variables"},
    {"ls dir pwd cd cat less head tail grep vi vim nano emacs mkdir rm cp mv chmod sh bash sudo ssh git make python "
     "python3 gnuplot",
     shell_is_elsewhere},
    {"man", "help \"name\" explains a name"},
    {"history", "the up arrow brings earlier lines back, Ctrl-R searches them, and :save writes them into a script"},
    {"save", ":save writes what was typed into a script, run:save(\"run.csv\") a run into a file"},
    {"reset", ":reset forgets your variables"},
    {"hilfe ayuda aide aiuto hallo hello hola", "help() starts a tour, and ?name explains a name"},
}};

/// Words before the name of a script that shall run.
constexpr std::array<std::string_view, 8> runs_script = {"dinal",  "lua",  "run", "source",
                                                         "dofile", "load", "sh",  "bash"};

bool is_one_of(std::string_view words, std::string_view word) {
    const std::vector<lua::Token> all = lua::tokens(words);
    return std::any_of(all.begin(), all.end(), [word](const lua::Token& one) { return one.text == word; });
}

/// Raw: to ask must not run the code of a strict _G.
bool holds_something(lua_State* L, std::string_view name) {
    lua_pushglobaltable(L);
    lua_pushlstring(L, name.data(), name.size());
    const bool there = lua_rawget(L, -2) != LUA_TNIL;
    lua_pop(L, 2);
    return there;
}

/// A word behind a space, such as a shell has them: lab.lua, -la, .., ~/x, --report; not what Lua can go on with: = ( ,
/// .
bool is_argument(std::string_view rest) {
    if (rest.size() < 2 || rest.front() != ' ') return false;
    const std::string_view word = text::trimmed(rest);
    if (word.empty()) return false;
    if (word.starts_with("..")) return word.size() == 2 || word[2] == '/';
    constexpr std::string_view heads = "-./~*";
    const bool shell_sign = heads.find(word.front()) != std::string_view::npos;
    const std::vector<lua::Token> all = lua::tokens(word);
    const bool plain =
        !all.empty() && (all.front().kind == lua::TokenKind::name || all.front().kind == lua::TokenKind::number);
    return plain || (shell_sign && word.size() > 1 && word[1] != ' ');
}

/// What stands before the first space.
std::string_view first_word(std::string_view text) {
    return text.substr(0, text.find(' '));
}

}  // namespace

std::string_view instead_of_word(std::string_view word) {
    const auto* const found = std::find_if(words_and_cures.begin(), words_and_cures.end(),
                                           [word](const Row& row) { return is_one_of(row.first, word); });
    return found == words_and_cures.end() ? std::string_view() : found->second;
}

std::string instead_of_shell_line(lua_State* L, std::string_view line) {
    line = text::trimmed(line.substr(0, line.find('\n')));
    if (line.starts_with("$ ")) line = text::trimmed(line.substr(2));  // copied along with its prompt
    if (line.starts_with('!') || line.starts_with("./") || line.starts_with("../"))
        return std::string(shell_is_elsewhere);
    if (line.starts_with('%')) return "lines with % are for IPython, and nothing of that is needed here";
    const std::vector<lua::Token> all = lua::tokens(line);
    if (all.empty() || all.front().kind != lua::TokenKind::name || !is_argument(line.substr(all.front().end()))) {
        return "";
    }
    const std::string_view command = all.front().text;
    const std::string_view argument = first_word(text::trimmed(line.substr(all.front().end())));
    const bool runs = std::find(runs_script.begin(), runs_script.end(), command) != runs_script.end();
    const bool from_shell = command == "dinal";
    std::string leaving = from_shell ? "that is a command of the shell, and Ctrl-D leads there" : "";
    if (runs && argument.ends_with(".lua") && !lua::safe_mode()) {
        return leaving + (from_shell ? "; here: " : "a script is run by ") + "dofile(\"" + std::string(argument) +
               "\")";
    }
    if (from_shell) return leaving;
    return holds_something(L, command) ? "" : std::string(instead_of_word(command));
}

}  // namespace dinal::errors
