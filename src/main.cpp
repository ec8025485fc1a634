// The program dinal: parses arguments, runs a script or the prompt, returns an exit code.
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "help/help_text.hpp"
#include "notebook/kernel.hpp"
#include "prompt/arguments.hpp"
#include "prompt/marking.hpp"
#include "prompt/output.hpp"
#include "prompt/script.hpp"

namespace {

int print(const std::string& text) {
    dinal::prompt::say(text);
    return dinal::prompt::exit_code::ok;
}

int print(const dinal::text::Expected<std::string>& text) {
    if (!text) {
        dinal::prompt::complain(text.error().message());
        return dinal::prompt::exit_code::script_error;
    }
    return print(text.value());
}

/// Adds the sheets of --sheets or DINAL_SHEETS.
std::optional<dinal::text::Error> add_sheets(const dinal::prompt::Arguments& arguments) {
    const char* variable = arguments.ignore_environment ? nullptr : std::getenv("DINAL_SHEETS");
    const std::string folder = arguments.sheets.empty() && variable != nullptr ? variable : arguments.sheets;
    return folder.empty() ? std::nullopt : dinal::prompt::add_sheets(folder);
}

int carry_out(const dinal::prompt::Arguments& arguments) {
    if (const auto wrong = add_sheets(arguments)) {
        dinal::prompt::complain(wrong->message());
        return dinal::prompt::exit_code::usage;
    }
    switch (arguments.request) {
        case dinal::prompt::Request::help:
            return print(dinal::prompt::help_text());
        case dinal::prompt::Request::version:
            return print(dinal::prompt::version_text());
        case dinal::prompt::Request::manual:
            return print(dinal::help::manual(arguments.student));
        case dinal::prompt::Request::lab_start:
            return print(dinal::prompt::start_script(arguments));
        case dinal::prompt::Request::lab_solutions:
            return print(dinal::prompt::solutions_of(arguments.student));
        case dinal::prompt::Request::test_sheet:
            return print(dinal::prompt::test_sheet(arguments.student));
        case dinal::prompt::Request::mark:
            return dinal::prompt::mark(arguments);
        case dinal::prompt::Request::jupyter_install:
            return print(dinal::notebook::install_kernel());
        case dinal::prompt::Request::run:
            break;
    }
    return dinal::prompt::run(arguments, dinal::notebook::run_kernel);
}

}  // namespace

int main(int count, char** words) {
    static_cast<void>(std::setlocale(LC_CTYPE, ""));  // not LC_ALL: 1.5 must not become 1,5
    const auto arguments = dinal::prompt::parse_arguments(count, words);
    if (!arguments) {
        dinal::prompt::complain(arguments.error().sentence +
                                "\nusage: dinal [options] [script [arguments]]; dinal --help lists the options");
        return dinal::prompt::exit_code::usage;
    }
    const int code = carry_out(*arguments);
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        dinal::prompt::complain("standard output could not be written to its end");
        return code == dinal::prompt::exit_code::ok ? dinal::prompt::exit_code::script_error : code;
    }
    return code;
}
