#include "prompt/commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "files/file.hpp"
#include "help/help_text.hpp"
#include "lua/bind.hpp"
#include "lua/lua_text.hpp"
#include "lua/safe_mode.hpp"
#include "lua/standard_globals.hpp"
#include "prompt/call.hpp"
#include "prompt/completion.hpp"
#include "prompt/notices.hpp"
#include "prompt/output.hpp"
#include "prompt/session.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/suggest.hpp"
#include "text/words.hpp"

namespace dinal::prompt {

namespace {

void help(Session& session, const std::string& argument);

void quit(Session& session, const std::string&) {
    session.leaving = true;
}

void time(Session& session, const std::string& text) {
    const auto begin = std::chrono::steady_clock::now();
    run_text(session, text);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
    say(fmt::format("{:.3g} s\n", taken.count()));
}

void save(Session& session, const std::string& file) {
    if (const auto saved = session.record.save(file); !saved) {
        say_error(":save: " + saved.error().sentence);
        return;
    }
    say(fmt::format("the inputs so far, without the errors, are in {}\n", file));
}

void load(Session& session, const std::string& file) {
    lua_State* L = session.L;
    lua_settop(L, 0);
    if (load_file(L, file.c_str()) != LUA_OK) {
        say_error(load_error_text(L, file.c_str()));
    } else if (evaluate(L, Chunk{Compiled::ready, "", "", true}).fine) {
        if (!session.record.writes(file)) {
            session.record.add_statement(fmt::format("dofile({})", text::quoted(file)));
        }
        const auto text = files::read_file(file);
        say_notice(text ? local_notice(*text) : "");
    }
    lua_settop(L, 0);
}

void history(Session& session, const std::string& argument) {
    constexpr std::size_t usual = 20;
    const std::size_t all = session.inputs.size();
    const std::size_t wanted = argument.empty() ? usual : std::strtoul(argument.c_str(), nullptr, 10);
    for (std::size_t i = all - std::min(wanted, all); i < all; ++i) {
        say_value(fmt::format("{:4}  {}\n", i + 1, text::indented(session.inputs[i], 6)));
    }
}

/// Lets the user change the text in an editor; returns the result or an error.
text::Expected<std::string> edited(const std::string& text) {
    const char* editor = std::getenv("VISUAL");                                      // NOLINT(concurrency-mt-unsafe)
    editor = editor == nullptr || *editor == '\0' ? std::getenv("EDITOR") : editor;  // NOLINT(concurrency-mt-unsafe)
    std::string name = "/tmp/dinal-XXXXXX.lua";
    const int file = ::mkstemps(name.data(), 4);
    if (file < 0) return text::Error{"no file can be made in /tmp"};
    ::close(file);
    static_cast<void>(files::write_file(name, text + "\n"));
    const std::string command = fmt::format("{} {}", editor == nullptr || *editor == '\0' ? "nano" : editor, name);
    const int status = std::system(command.c_str());  // NOLINT: the user chose the editor
    auto changed = files::read_file(name);
    ::unlink(name.c_str());
    if (status != 0) return text::error("'{}' failed; the variable EDITOR names an editor", command);
    return changed;
}

void edit(Session& session, const std::string& argument) {
    if (lua::safe_mode()) {
        say_error(":edit is not possible in safe mode, which starts no programs");
        return;
    }
    const std::size_t all = session.inputs.size();
    const std::size_t number = argument.empty() ? all : std::strtoul(argument.c_str(), nullptr, 10);
    if (number > all || (number == 0 && !argument.empty())) {
        say_error(fmt::format(":edit needs the number of an input, from 1 to {}; :history lists them", all));
        return;
    }
    const auto text = edited(number == 0 ? "" : session.inputs[number - 1]);
    if (!text) {
        say_error(":edit: " + text.error().message());
        return;
    }
    const std::string input(text::trimmed(*text));
    if (input.empty()) return;
    say_value(input + "\n");
    session.editor.remember(input);
    session.inputs.push_back(input);
    run_text(session, input);
}

int print_globals(lua_State* L) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::vector<std::string> names = lua::users_globals(L);
    for (const std::string& name : names) {
        lua::push_global(L, name);
        const std::string head = fmt::format("  {:<9} ", name);
        say_value(head + show_line(L, -1, screen, screen.width - std::min(text::columns(head), screen.width / 2) - 1) +
                  "\n");
        lua_pop(L, 1);
    }
    if (names.empty()) {
        say("no variables of your own yet\n");
    }
    return 0;
}

void who(Session& session, const std::string&) {
    lua_pushcfunction(session.L, print_globals);
    if (call(session.L, 0, 0) != LUA_OK) {
        say_error(take_text(session.L));
    }
}

void reset(Session& session, const std::string&) {
    lua::reset_globals(session.L);
    session.record.clear();
    say("all your variables are deleted; the names of Lua and dinal are restored\n");
}

void show_folder(Session& /*session*/, const std::string& /*argument*/) {
    std::error_code wrong;
    const std::filesystem::path folder = std::filesystem::current_path(wrong);
    wrong ? say_error(":pwd: " + wrong.message()) : say_value(text::displayable(folder.string()) + "\n");
}

/// Expands ~ in a folder's name.
std::string folder_of(const std::string& typed) {
    const char* home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe)
    const bool at_home = home != nullptr && (typed.empty() || typed == "~" || typed.starts_with("~/"));
    return at_home ? home + (typed.empty() ? "" : typed.substr(1)) : typed;
}

void change_folder(Session& session, const std::string& folder) {
    if (lua::safe_mode()) {
        say_error(":cd is not possible in safe mode, which stays in the folder where dinal was started");
        return;
    }
    std::error_code wrong;
    std::filesystem::current_path(folder_of(folder), wrong);
    wrong ? say_error(fmt::format(":cd: '{}': {}", text::displayable(folder), wrong.message()))
          : show_folder(session, "");
}

void list_folder(Session& /*session*/, const std::string& argument) {
    const std::string folder = argument.empty() ? "." : folder_of(argument);
    if (lua::safe_mode() && !argument.empty()) {
        say_error(":ls: safe mode shows the current folder only");
        return;
    }
    std::vector<std::string> names;
    std::error_code wrong;
    for (std::filesystem::directory_iterator place(folder, wrong);
         !wrong && place != std::filesystem::directory_iterator(); place.increment(wrong)) {
        const std::string name = place->path().filename().string();
        std::error_code vanished;
        if (!name.starts_with('.'))
            names.push_back(text::displayable(name) + (place->is_directory(vanished) ? "/" : ""));
    }
    if (wrong) {
        say_error(fmt::format(":ls: '{}': {}", text::displayable(folder), wrong.message()));
        return;
    }
    std::ranges::sort(names);
    const std::size_t width = terminal::display_of(STDOUT_FILENO).width;
    say_value(names.empty() ? "no files\n" : text::wrapped(fmt::format("{}", fmt::join(names, "  ")), width) + "\n");
}

enum class Argument { none, optional, needed };

struct Command {
    std::string_view name;
    Argument argument;
    std::string_view usage;
    std::string_view summary;
    void (*run)(Session&, const std::string&);
    bool file = false;  // whether the argument is a file name
};

constexpr std::array<Command, 13> commands = {{
    {"help", Argument::optional, ":help [name]", "This list, or what help \"name\" says.", help},
    {"quit", Argument::none, ":quit", "Leaves dinal, like Ctrl-D.", quit},
    {"time", Argument::needed, ":time code", "Runs code once and prints the time it took.", time},
    {"save", Argument::needed, ":save file",
     "Writes the inputs of this session so far, without the errors, to a script.", save, true},
    {"load", Argument::needed, ":load file", "Runs a script; its global variables stay.", load, true},
    {"history", Argument::optional, ":history [n]", "Lists the last 20 inputs of this session, or n.", history},
    {"edit", Argument::optional, ":edit [n]",
     "Opens the last input, or the n-th of :history, in your editor (EDITOR), and runs it.", edit},
    {"who", Argument::none, ":who", "Lists your own variables.", who},
    {"cd", Argument::optional, ":cd [folder]", "Changes the current folder, without an argument to your own.",
     change_folder, true},
    {"pwd", Argument::none, ":pwd", "Shows the current folder.", show_folder},
    {"ls", Argument::optional, ":ls [folder]", "Lists the files of the current folder, or of another one.", list_folder,
     true},
    {"reset", Argument::none, ":reset", "Deletes all your variables and the record for :save.", reset},
    {"q", Argument::none, ":q", "The same as :quit.", quit},
}};

void help(Session& session, const std::string& argument) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    if (!argument.empty() && argument.front() != ':') {
        terminal::show_in_pages(answer_to(session.L, argument));
        return;
    }
    std::string text;
    for (const Command& command : commands) {
        if (command.name.size() > 1) {
            text += help::line_about(command.usage, command.summary, screen);
        }
    }
    text += help::line_about("?name, name?", "The same as help \"name\".", screen);
    text += help::line_about("help()", "A tour of two minutes.", screen);
    text += help::line_about("code ;", "A semicolon at the end: the value is not shown.", screen);
    say(text);
}

/// The command with this name, or with a unique beginning; otherwise nullptr.
const Command* find(std::string_view name) {
    const auto* const exact = std::ranges::find(commands, name, &Command::name);
    if (exact != commands.end()) {
        return exact;
    }
    const auto begins = [name](const Command& c) { return !name.empty() && c.name.starts_with(name); };
    const auto* const first = std::ranges::find_if(commands, begins);
    const bool only = std::ranges::count_if(commands, begins) == 1;
    return only ? first : nullptr;
}

/// Accepts quotes around a file name as in Lua: :load "lab.lua".
std::string without_quotes(const std::string& text) {
    const bool is_quoted =
        text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front();
    return is_quoted ? text.substr(1, text.size() - 2) : text;
}

std::string_view name_of(std::string_view line) {
    return line.substr(1, line.find_first_of(" \t(\"'") - 1);
}

void tell_unknown(std::string_view name) {
    std::vector<std::string_view> names;
    std::ranges::transform(commands, std::back_inserter(names), [](const Command& c) { return c.name; });
    const std::string hint =
        name == "record" ? "; :save writes your inputs to a script" : text::did_you_mean(name, names);
    say_error(fmt::format("there is no command :{}{}", name, hint.empty() ? "; :help lists them" : hint));
}

}  // namespace

bool is_command(std::string_view line) {
    return (line.starts_with(':') && !line.starts_with("::")) || is_question(line);
}

void run_command(Session& session, const std::string& line) {
    if (is_question(line)) {
        terminal::show_in_pages(answer_to(session.L, line));
        return;
    }
    const std::string_view name = name_of(line);
    const Command* command = find(name);
    if (command == nullptr) {
        tell_unknown(name);
        return;
    }
    std::string argument(text::trimmed(std::string_view(line).substr(1 + name.size())));
    argument = command->file ? without_quotes(argument) : argument;
    if (command->argument == Argument::needed && argument.empty()) {
        say_error(fmt::format("write {}", command->usage));
    } else if (command->argument == Argument::none && !argument.empty()) {
        say_error(fmt::format(":{} takes no argument", command->name));
    } else {
        command->run(session, argument);
    }
}

Completion complete_command(lua_State* L, std::string_view before) {
    const std::size_t end = before.find(' ');
    if (end == std::string_view::npos) {
        Completion completion;
        for (const Command& command : commands) {
            if (command.name.starts_with(before.substr(1)) && command.name.size() > 1) {
                completion.names.push_back(std::string(command.name) + (command.argument == Argument::none ? "" : " "));
            }
        }
        return completion;
    }
    const Command* command = find(before.substr(1, end - 1));
    if (command != nullptr && command->file) {
        return {{}, true};
    }
    const std::string_view argument = before.substr(end + 1);
    return command != nullptr && command->name == "help" ? complete(L, "?" + std::string(argument))
                                                         : complete(L, argument);
}

namespace {

/// The help on an expression whose meaning is known; pushes nothing.
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
    const lua::Tokens all = lua::tokens(line);
    return line.find('\n') == std::string_view::npos && !all.empty() && (all.front().is("?") || all.back().is("?"));
}

std::string answer_to(lua_State* L, std::string_view line) {
    const terminal::Display screen = terminal::display_of(STDOUT_FILENO);
    const std::string_view words = text::trimmed(line, " ?\"'", " ?\"'(){}");
    if (words.empty()) {
        return help::tour_page(1);
    }
    const std::vector<std::string> own = lua::users_globals(L);
    if (!help::lua_word(words).empty() && !text::contains(own, words)) {
        return help::help_about(words, screen);
    }
    const int top = lua_gettop(L);
    const lua::Tokens all = lua::tokens(words);
    const Meaning found = meaning(L, all);
    std::string answer = entry(found, screen);
    if (const std::vector<std::string> names = help::help_names();
        answer.empty() && found.kind == Meaning::Kind::value && !text::contains(names, words)) {
        lua_pushcfunction(L, show_value);
        lua_insert(L, -2);
        const bool shown = call(L, 1, 1) == LUA_OK;
        answer = take_text(L) + (shown ? "" : "\n");
    }
    lua_settop(L, top);
    return answer.empty() ? help::help_about(words, screen) : answer;
}

}  // namespace dinal::prompt
