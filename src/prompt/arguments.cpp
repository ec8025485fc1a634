#include "prompt/arguments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "text/suggest.hpp"

namespace dinal::prompt {
namespace {

constexpr double longest = 1e8;                         // seconds: 3 years
constexpr std::size_t largest = std::size_t{1} << 40U;  // a terabyte

/// Parses seconds, "10" or "0.5"; returns 0 if the text is not a positive number.
double seconds_of(std::string_view text) {
    double seconds = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), seconds);
    const bool good = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
    return good && seconds > 0 && seconds <= longest ? seconds : 0;
}

/// Parses a size in bytes, "256M", "1G", "500K" or "1000000"; returns 0 if the text is not a size.
std::size_t size_of(std::string_view text) {
    std::size_t size = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), size);
    const std::string_view letter = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
    const std::size_t unit = letter.empty() ? 0 : std::string_view("KMG").find(letter) + 1;  // 0: unknown letter
    const bool good = parsed.ec == std::errc() && letter.size() <= 1 && (letter.empty() || unit > 0);
    return good && size <= largest >> (10 * unit) ? size << (10 * unit) : 0;
}

// ---- effects of options; they return false if the value is invalid

template <auto... flags>
bool set(Arguments& arguments, std::string_view /*value*/) {
    ((arguments.*flags = true), ...);
    return true;
}

template <auto text>
bool take(Arguments& arguments, std::string_view value) {
    arguments.*text = value;
    return !value.empty();
}

/// Requests something instead of a run, with an optional value.
template <Request request>
bool ask(Arguments& arguments, std::string_view value) {
    arguments.request = request;
    arguments.student = value;
    return true;
}

bool turn_warnings_on(Arguments& arguments, std::string_view /*value*/) {
    arguments.steps.push_back({'W', ""});
    return true;
}

bool limit_time(Arguments& arguments, std::string_view value) {
    arguments.limits.seconds = seconds_of(value);
    return arguments.limits.seconds > 0;
}

bool limit_memory(Arguments& arguments, std::string_view value) {
    arguments.limits.memory = size_of(value);
    return arguments.limits.memory > 0;
}

bool answer_on(Arguments& arguments, std::string_view value) {
    int number = -1;
    std::from_chars(value.data(), value.data() + value.size(), number);
    arguments.kernel = number;
    return true;
}

enum class Takes {
    nothing,
    value,   ///< --max-time 10 or --max-time=10
    joined,  ///< --manual or --manual=runs; the rest of the line is ignored
    all,     ///< no value; the rest of the line is ignored
};

struct CommandLineOption {
    std::string_view name;
    bool (*carry_out)(Arguments& arguments, std::string_view value);
    Takes takes = Takes::nothing;
    const char *needs = "", *example = "";  ///< description and example of its value
};

constexpr CommandLineOption options[] = {
    {"-i", set<&Arguments::interactive, &Arguments::show_version>},
    {"-v", set<&Arguments::show_version>},
    {"-E", set<&Arguments::ignore_environment>},
    {"-W", turn_warnings_on},
    {"-h", ask<Request::help>, Takes::all},
    {"--help", ask<Request::help>, Takes::all},
    {"--version", ask<Request::version>, Takes::all},
    {"--manual", ask<Request::manual>, Takes::joined},
    {"--jupyter-install", ask<Request::jupyter_install>, Takes::all},
    {"--no-init", set<&Arguments::no_init>},
    {"--strict", set<&Arguments::strict>},
    {"--safe", set<&Arguments::safe>},
    {"--report", set<&Arguments::report>},
    {"--max-time", limit_time, Takes::value, "a time in seconds", "10"},
    {"--max-memory", limit_memory, Takes::value, "a size", "256M"},
    {"--lab-marks", take<&Arguments::lab_marks>, Takes::value, "the name of a file", "marks.csv"},
    {"--sheets", take<&Arguments::sheets>, Takes::value, "the name of a folder", "sheets"},
    {"--lab", ask<Request::lab_start>, Takes::value},
    {"--lab-solutions", ask<Request::lab_solutions>, Takes::value},
    {"--test-sheet", ask<Request::test_sheet>, Takes::value},
    {"--mark", ask<Request::mark>, Takes::value},
    {"--kernel", answer_on, Takes::value},
};

/// The option for a word, "--max-time" also for "--max-time=10"; nullptr if unknown.
const CommandLineOption* option_of(std::string_view word) {
    const auto* found = std::find_if(std::begin(options), std::end(options), [word](const CommandLineOption& option) {
        return option.name ==
               (option.takes == Takes::value || option.takes == Takes::joined ? word.substr(0, word.find('=')) : word);
    });
    return found == std::end(options) ? nullptr : found;
}

/// Applies the option at index i; advances i to its value if that is a separate word.
std::optional<text::Error> carry_out(const CommandLineOption& option, Arguments& arguments, std::size_t& i) {
    std::string_view value = arguments.words[i];
    const bool joined = value.size() > option.name.size();
    value.remove_prefix(std::min(value.size(), option.name.size() + 1));
    if (option.takes == Takes::value && !joined && ++i < arguments.words.size()) value = arguments.words[i];
    if (option.carry_out(arguments, value)) return std::nullopt;
    return text::error("option {} needs {} after it, for example {} {}{}", option.name, option.needs, option.name,
                       option.example, value.empty() ? "" : fmt::format("; '{}' is not one", value));
}

/// Sets the safe-mode limits that the user has not given.
void complete_safe_limits(lua::ScriptLimits& limits) {
    limits.memory = limits.memory > 0 ? limits.memory : lua::safe_limits.memory;
    limits.seconds = limits.seconds > 0 ? limits.seconds : lua::safe_limits.seconds;
}

text::Error unknown(std::string_view word) {
    std::vector<std::string_view> known{"-e", "-l", "-", "--"};
    for (const CommandLineOption& option : options) known.push_back(option.name);
    return {fmt::format("unknown option '{}'{}", word, text::did_you_mean(word, known))};
}

text::Error no_value(char option) {
    return {option == 'e' ? "option -e needs Lua code after it, for example -e 'print(1 + 1)'"
                          : "option -l needs the name of a module after it, for example -l lab"};
}

/// Rejects incompatible options, and adds those that safe mode implies.
std::optional<text::Error> settle(Arguments& arguments) {
    if (arguments.report) {
        arguments.safe = arguments.strict = true;  // a page to hand in is made under the rules of its marking
    }
    if (!arguments.safe) {
        return std::nullopt;
    }
    for (const StartStep& step : arguments.steps) {
        if (step.option == 'l') {
            return text::error("-l {} is not possible with --safe, which loads no modules", step.value);
        }
    }
    arguments.ignore_environment = true;
    complete_safe_limits(arguments.limits);
    return std::nullopt;
}

}  // namespace

text::Expected<Arguments> parse_arguments(int count, const char* const* words) {
    Arguments arguments;
    arguments.words.assign(words, words + count);
    std::size_t i = 1;
    for (; i < arguments.words.size(); ++i) {
        const std::string_view word = arguments.words[i];
        if (word.size() < 2 || word[0] != '-') {
            break;  // a script, or "-" for standard input
        }
        if (word == "--") {
            ++i;
            break;
        }
        if (const CommandLineOption* option = option_of(word)) {
            if (auto wrong = carry_out(*option, arguments, i)) {
                return *wrong;
            }
            if (option->takes == Takes::all || option->takes == Takes::joined) {
                return arguments;
            }
        } else if (word[1] == 'e' || word[1] == 'l') {
            const char* value = arguments.words[i] + 2;
            if (*value == '\0') {
                // NOTE: as in lua, a value with a leading dash must be joined to its option: -e-x.
                if (i + 1 == arguments.words.size() || arguments.words[i + 1][0] == '-') {
                    return no_value(word[1]);
                }
                value = arguments.words[++i];
            }
            arguments.steps.push_back({word[1], value});
            arguments.executes = arguments.executes || word[1] == 'e';
        } else {
            return unknown(word);
        }
    }
    arguments.script = i;
    if (arguments.report && !arguments.has_script()) {
        return text::Error{"--report needs a script after it: dinal --report lab.lua makes lab.html"};
    }
    if (auto wrong = settle(arguments)) {
        return *wrong;
    }
    return arguments;
}

std::string help_text() {
    return R"(dinal: a laboratory for oscillators with dry friction, driven from Lua

usage: dinal [options] [script [arguments]]

without a script: a prompt on a terminal, otherwise standard input is run as a script
  -e code    run a piece of Lua code
  -l mod     require the module 'mod' into the global 'mod'
  -l g=mod   require the module 'mod' into the global 'g'
  -i         a prompt after the script
  -v         show the version, then go on
  -W         turn Lua's warnings on
  -E         ignore environment variables (LUA_INIT, LUA_PATH, LUA_CPATH)
  --         no more options: what follows is the script
  -          no more options: run standard input as the script
  --no-init  a prompt without the file ~/.config/dinal/init.lua
  --strict   make an undefined variable an error, and an option whose value is
             nil by a misspelt name
  --safe     for scripts of strangers: no files outside the current folder, no
             processes, no modules, and limits:
             --max-memory 256M --max-time 10
  --max-memory SIZE  end a script that needs more, for example 256M or 2G
  --max-time SECONDS end a script that needs more processor time; at the prompt,
                     an input
  --lab SHEET NUMBER write the script to begin a lab sheet with: --lab 1 4711, or in
                     Spanish --lab hoja-1 4711
  --lab-marks FILE   append the verdict on each answer in the lab to FILE
  --lab-solutions NUMBER  the answers of a student number, for instructors
  --mark FOLDER      run all hand-ins of a folder in safe mode: a table, a summary,
                     and a page of each in FOLDER-marked
  --sheets FOLDER    add the lab sheets of a folder (or DINAL_SHEETS=FOLDER)
  --test-sheet FILE  test a lab sheet of your own, and show it as a student sees it
  --report   run the script in safe mode, and make a page to hand in: lab.html of
             lab.lua, with what it prints and draws, and the verdicts on its answers
  --jupyter-install  make dinal a kernel of Jupyter notebooks, for this user, also a safe one
  --kernel=N         what such a kernel runs: requests on standard input, answers
                     on the descriptor N, as lines of JSON
  --help     this text
  --version  version, licence and what is built in
  --manual   the index of the manual, as Markdown; --manual=runs and the like: a topic

exit codes: 0 all went well, 1 an error in Lua code, 2 a wrong option, 130 interrupted
inside: help() shows where to start
)";
}

}  // namespace dinal::prompt
