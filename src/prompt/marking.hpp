// dinal --mark FOLDER: runs the hand-ins of a lab in safe mode and tabulates their answers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "prompt/arguments.hpp"
#include "text/expected.hpp"

namespace dinal::prompt {

/// Prints the table and a summary, and writes FOLDER-marked: marks.csv, and the page of each hand-in. Returns the exit
/// code.
int mark(const Arguments& arguments);

/// "1-4711.lua uses number 4712, but its name says 4711"; "" if the file name and the number set by the script agree.
std::string other_number(const std::string& file, std::int64_t used);

// Command-line services for students and instructors: initial scripts, solutions, own sheets and their test.

/// Writes the initial script of a sheet into the current folder. Returns instructions.
text::Expected<std::string> start_script(const Arguments& arguments);

/// Returns all answers for a student number. Fails unless this user has the instructor's file of this version.
text::Expected<std::string> solutions_of(const std::string& student);

/// Adds the sheets FOLDER/*.lua, sorted by name. Returns an error if that fails.
std::optional<text::Error> add_sheets(const std::string& folder);

/// Tests one sheet. Returns a student's view, or fails with its first fault.
text::Expected<std::string> test_sheet(const std::string& file);

}  // namespace dinal::prompt
