#include "prompt/arguments.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <optional>
#include <string_view>

#include "text/suggest.hpp"

namespace dinal::prompt {
namespace {

constexpr std::array<std::string_view, 25> known_options = {
    "-e",        "-l",           "-i",         "-v",           "-W",          "-E",
    "-",         "--",           "-h",         "--help",       "--version",   "--manual",
    "--no-init", "--safe",       "--max-time", "--max-memory", "--lab-marks", "--lab-solutions",
    "--sheets",  "--test-sheet", "--mark",     "--report",     "--kernel",    "--jupyter-install"};

constexpr std::string_view kernel_option = "--kernel";
constexpr std::string_view time_option = "--max-time";
constexpr std::string_view memory_option = "--max-memory";
constexpr std::string_view marks_option = "--lab-marks";
constexpr std::string_view solutions_option = "--lab-solutions";
constexpr std::string_view sheets_option = "--sheets";
constexpr std::string_view test_option = "--test-sheet";
constexpr std::string_view mark_option = "--mark";
constexpr double longest = 1e9;                         // seconds: 30 years
constexpr std::size_t largest = std::size_t{1} << 40U;  // a terabyte
constexpr lua::ScriptLimits safe{.memory = std::size_t{256} << 20U, .seconds = 10};

/// "10", "0.5"; 0 when it is no positive number.
double seconds_of(std::string_view text) {
    double seconds = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), seconds);
    const bool good = parsed.ec == std::errc() && parsed.ptr == text.data() + text.size();
    return good && seconds > 0 && seconds <= longest ? seconds : 0;
}

/// "256M", "1G", "500K", "1000000"; 0 when it is no size.
std::size_t size_of(std::string_view text) {
    std::size_t size = 0;
    const auto parsed = std::from_chars(text.data(), text.data() + text.size(), size);
    const std::string_view letter = text.substr(static_cast<std::size_t>(parsed.ptr - text.data()));
    const std::size_t unit = letter.empty() ? 0 : std::string_view("KMG").find(letter) + 1;  // 0 when there is no such
    const bool good = parsed.ec == std::errc() && letter.size() <= 1 && (letter.empty() || unit > 0);
    return good && size <= largest >> (10 * unit) ? size << (10 * unit) : 0;
}

/// Which of those with a value a word is, "--max-time" also for "--max-time=10"; empty when it is none.
std::string_view option_with_value(std::string_view word) {
    const std::string_view name = word.substr(0, word.find('='));
    for (const std::string_view option :
         {time_option, memory_option, marks_option, solutions_option, sheets_option, test_option, mark_option}) {
        if (name == option) {
            return option;
        }
    }
    return {};
}

/// Fails with a sentence about a value that is no size or no time.
std::optional<text::Error> set_limit(lua::ScriptLimits& limits, std::string_view option, std::string_view value) {
    const bool time = option == time_option;
    limits.seconds = time ? seconds_of(value) : limits.seconds;
    limits.memory = time ? limits.memory : size_of(value);
    if (time ? limits.seconds > 0 : limits.memory > 0) {
        return std::nullopt;
    }
    return text::Error{fmt::format("option {} needs {} after it, for example {}{}", option,
                                   time ? "a time in seconds" : "a size", time ? "--max-time 10" : "--max-memory 256M",
                                   value.empty() ? "" : fmt::format("; '{}' is not one", value))};
}

/// What safe mode allows where the user has not said otherwise.
void complete_safe_limits(lua::ScriptLimits& limits) {
    limits.memory = limits.memory > 0 ? limits.memory : safe.memory;
    limits.seconds = limits.seconds > 0 ? limits.seconds : safe.seconds;
}

text::Error unknown(std::string_view option) {
    return {fmt::format("unknown option '{}'{}", option, text::did_you_mean(option, known_options))};
}

text::Error no_value(char option) {
    return {option == 'e' ? "option -e needs Lua code after it, for example -e 'print(1 + 1)'"
                          : "option -l needs the name of a module after it, for example -l lab"};
}

/// What stands behind --kernel: "=11". -1, which is none, for all else.
int descriptor_of(std::string_view text) {
    int number = -1;
    if (text.starts_with('=')) {
        std::from_chars(text.data() + 1, text.data() + text.size(), number);
    }
    return number;
}

/// --help and its like, which `lua` does not have. Request::run when it is none of them.
Request request_of(std::string_view option) {
    if (option == "--help" || option == "-h") {
        return Request::help;
    }
    if (option == "--version") {
        return Request::version;
    }
    if (option == "--jupyter-install") {
        return Request::jupyter_install;
    }
    return option == "--manual" || option == "--manual=all" ? Request::manual : Request::run;
}

/// A flag of one letter; false when `lua` does not have it.
bool set_flag(Arguments& arguments, char letter) {
    switch (letter) {
        case 'i':
            arguments.interactive = arguments.show_version = true;
            return true;
        case 'v':
            arguments.show_version = true;
            return true;
        case 'E':
            arguments.ignore_environment = true;
            return true;
        case 'W':
            arguments.steps.push_back({'W', ""});
            return true;
        default:
            return false;
    }
}

/// Fails with a sentence about a value that will not do.
std::optional<text::Error> set_value(Arguments& arguments, std::string_view option, std::string_view value) {
    if (option == marks_option) {
        arguments.lab_marks = value;
        return value.empty() ? std::optional(text::Error{"option --lab-marks needs the name of a file after it, for "
                                                         "example --lab-marks marks.csv"})
                             : std::nullopt;
    }
    if (option == sheets_option) {
        arguments.sheets = value;
        return value.empty() ? std::optional(text::Error{"option --sheets needs the name of a folder after it, for "
                                                         "example --sheets sheets"})
                             : std::nullopt;
    }
    if (option == solutions_option || option == test_option || option == mark_option) {
        arguments.request = option == solutions_option ? Request::lab_solutions
                            : option == test_option    ? Request::test_sheet
                                                       : Request::mark;
        arguments.student = value;
        return std::nullopt;
    }
    return set_limit(arguments.limits, option, value);
}

/// --max-time 10 or --max-time=10 at place i, which goes to the value.
std::optional<text::Error> read_value(Arguments& arguments, std::string_view option, std::size_t& i) {
    const std::string_view word = arguments.words[i];
    if (word.size() > option.size()) {
        return set_value(arguments, option, word.substr(option.size() + 1));
    }
    ++i;
    return set_value(arguments, option, i < arguments.words.size() ? arguments.words[i] : "");
}

/// What is not possible together; what safe mode brings with it.
std::optional<text::Error> settle(Arguments& arguments) {
    if (arguments.report) {
        arguments.safe = arguments.strict = true;  // a page to hand in comes about under the rules that it is marked by
    }
    if (!arguments.safe) {
        return std::nullopt;
    }
    for (const StartStep& step : arguments.steps) {
        if (step.option == 'l') {
            return text::Error{fmt::format("-l {} is not possible with --safe, which loads no modules", step.value)};
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
        if (word == "--no-init") {
            arguments.no_init = true;
            continue;
        }
        if (const Request request = request_of(word); request != Request::run) {
            arguments.request = request;
            arguments.whole_manual = word == "--manual=all";
            return arguments;
        }
        if (word == "--report") {
            arguments.report = true;
        } else if (word == "--safe") {
            arguments.safe = true;
        } else if (word == "--strict") {
            arguments.strict = true;
        } else if (word.starts_with(kernel_option)) {
            arguments.kernel = descriptor_of(word.substr(kernel_option.size()));
        } else if (const std::string_view option = option_with_value(word); !option.empty()) {
            if (auto wrong = read_value(arguments, option, i)) {
                return *wrong;
            }
        } else if (word[1] == 'e' || word[1] == 'l') {
            const char* value = arguments.words[i] + 2;
            if (*value == '\0') {
                // NOTE: as in lua, a value that begins with a dash must be joined to its option: -e-x.
                if (i + 1 == arguments.words.size() || arguments.words[i + 1][0] == '-') {
                    return no_value(word[1]);
                }
                value = arguments.words[++i];
            }
            arguments.steps.push_back({word[1], value});
            arguments.executes = arguments.executes || word[1] == 'e';
        } else if (word.size() != 2 || !set_flag(arguments, word[1])) {
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
             processes except gnuplot, no modules, and limits:
             --max-memory 256M --max-time 10
  --max-memory SIZE  end a script that needs more, for example 256M or 2G
  --max-time SECONDS end a script that runs longer; at the prompt, an input
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
  --manual   the whole manual, as Markdown

exit codes: 0 all went well, 1 an error in Lua code, 2 a wrong option, 130 interrupted
inside: help() shows where to start
)";
}

}  // namespace dinal::prompt
