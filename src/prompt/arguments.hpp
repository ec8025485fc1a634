// The command line: the options of `lua`, parsed like lua's, and long options such as --help and --safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lua/safe_mode.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

enum class Request { run, help, version, manual, lab_start, lab_solutions, test_sheet, mark, jupyter_install };

/// -e, -l or -W, which are executed in the order given.
struct StartStep {
    char option;
    const char* value;  ///< text for -e, module for -l
};

struct Arguments {
    Request request = Request::run;
    bool interactive = false;         ///< -i
    bool show_version = false;        ///< -v or -i
    bool executes = false;            ///< -e
    bool ignore_environment = false;  ///< -E
    bool no_init = false;             ///< --no-init
    bool safe = false;                ///< --safe
    bool report = false;              ///< --report
    bool strict = false;              ///< --strict
    std::optional<int> kernel;        ///< --kernel: descriptor for its answers
    lua::ScriptLimits limits;         ///< --max-memory, --max-time; always set in safe mode
    std::string lab_marks;            ///< --lab-marks: file for answers in the lab; empty: none
    std::string sheets;               ///< --sheets: folder of additional sheets
    std::string student;              ///< --lab-solutions: student number; --test-sheet: file; --mark: folder
    std::vector<StartStep> steps;
    std::vector<const char*> words;  ///< the whole command line
    std::size_t script = 0;          ///< index of the script in `words`; words.size() without a script

    bool has_script() const { return script < words.size(); }
};

/// Fails for the first option that is unknown or lacks its value.
text::Expected<Arguments> parse_arguments(int count, const char* const* words);

std::string help_text();

}  // namespace dinal::prompt
