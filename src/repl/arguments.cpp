#include "repl/arguments.hpp"

#include <fmt/core.h>

#include <array>
#include <string_view>

#include "core/suggest.hpp"

namespace dinal {
namespace {

constexpr std::array<std::string_view, 13> known_options = {
    "-e", "-l", "-i", "-v", "-W", "-E", "-", "--", "-h", "--help", "--version", "--manual", "--no-init"};

Error unknown(std::string_view option) {
    return {fmt::format("unknown option '{}'{}", option, did_you_mean(option, known_options))};
}

Error no_value(char option) {
    return {option == 'e' ? "option -e needs Lua code after it, for example -e 'print(1 + 1)'"
                          : "option -l needs the name of a module after it, for example -l lab"};
}

/// --help and its like, which `lua` does not have. Request::run when it is none of them.
Request request_of(std::string_view option) {
    if (option == "--help" || option == "-h") {
        return Request::help;
    }
    if (option == "--version") {
        return Request::version;
    }
    return option == "--manual" ? Request::manual : Request::run;
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

}  // namespace

Expected<Arguments> parse_arguments(int count, const char* const* words) {
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
            return arguments;
        }
        if (word[1] == 'e' || word[1] == 'l') {
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
    return arguments;
}

std::string help_text() {
    return R"(dinal: a laboratory for oscillators with dry friction, driven from Lua

usage: dinal [options] [script [arguments]]

without a script: a prompt on a terminal, else standard input is run as a script
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
  --help     this text
  --version  version, licence and what is built in
  --manual   the whole manual, as Markdown

exit codes: 0 all went well, 1 an error in Lua code, 2 a wrong option, 130 interrupted
inside: help() shows where to start
)";
}

}  // namespace dinal
