// dinal: arguments in, a script or the prompt, an exit code out.
#include <clocale>
#include <cstdio>

#include "help/manual.hpp"
#include "prompt/arguments.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"

namespace {

int print(const std::string& text) {
    dinal::say(text);
    return dinal::exit_code::ok;
}

int carry_out(const dinal::Arguments& arguments) {
    switch (arguments.request) {
        case dinal::Request::help:
            return print(dinal::help_text());
        case dinal::Request::version:
            return print(dinal::version_text());
        case dinal::Request::manual:
            return print(dinal::manual());
        case dinal::Request::run:
            break;
    }
    return dinal::run(arguments);
}

}  // namespace

int main(int count, char** words) {
    static_cast<void>(std::setlocale(LC_CTYPE, ""));  // not LC_ALL: 1.5 must not become 1,5
    const auto arguments = dinal::parse_arguments(count, words);
    if (!arguments) {
        dinal::complain(arguments.error().sentence +
                        "\nusage: dinal [options] [script [arguments]]; dinal --help lists the options");
        return dinal::exit_code::usage;
    }
    const int code = carry_out(*arguments);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        dinal::complain("standard output could not be written to its end");
        return code == dinal::exit_code::ok ? dinal::exit_code::script_error : code;
    }
    return code;
}
