// dinal --mark FOLDER: runs the hand-ins of a lab in safe mode and makes a table of their answers.
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

/// "1-4711.lua uses number 4712, but its name says 4711", for the number that the script has set; "" if they agree.
std::string other_number(const std::string& file, std::int64_t used);

// What a student and an instructor ask for on the command line: a script to begin with, solutions, sheets of his own
// and their test.

/// Writes the script with which a student begins a sheet into the current folder. Returns what to do with it.
text::Expected<std::string> start_script(const Arguments& arguments);

/// Returns all answers of a student number. Fails if this user has no file of the instructor, or that of another
/// version.
text::Expected<std::string> solutions_of(const std::string& student);

/// Adds the sheets of that folder, FOLDER/*.lua in the order of their names. Returns the reason if that fails.
std::optional<text::Error> add_sheets(const std::string& folder);

/// Tests one sheet. Returns what a student sees of it, or fails with its first fault.
text::Expected<std::string> test_sheet(const std::string& file);

}  // namespace dinal::prompt
