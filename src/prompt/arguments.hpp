// The command line: the options of `lua`, read as `lua` reads them, and those in words, such as --help and --safe.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lua/limits.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

enum class Request { run, help, version, manual, lab_start, lab_solutions, test_sheet, mark, jupyter_install };

/// -e, -l or -W: they are carried out in the order in which they stand.
struct StartStep {
    char option;
    const char* value;  ///< of -e and -l
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
    std::optional<int> kernel;        ///< --kernel: the descriptor for its answers
    lua::ScriptLimits limits;         ///< --max-memory, --max-time; in safe mode there are always some
    std::string lab_marks;            ///< --lab-marks: where answers in the lab are noted; empty: nowhere
    std::string sheets;               ///< --sheets: a folder with sheets that are not built in
    std::string student;              ///< --lab-solutions: whose; --test-sheet: the file; --mark: the folder
    std::vector<StartStep> steps;
    std::vector<const char*> words;  ///< the whole command line
    std::size_t script = 0;          ///< its place among the words; words.size() when there is none

    [[nodiscard]] bool has_script() const { return script < words.size(); }
};

/// Fails with a sentence about the first option that is not known or lacks its value.
text::Expected<Arguments> parse_arguments(int count, const char* const* words);

/// What --help prints.
std::string help_text();

}  // namespace dinal::prompt
