// dinal --mark FOLDER: runs the hand-ins of a lab in safe mode and makes a table of their answers.
#pragma once

#include "prompt/arguments.hpp"

namespace dinal::prompt {

/// Prints the table and a summary, and writes FOLDER-marked: marks.csv, and the page of each hand-in. Returns the exit
/// code.
int mark(const Arguments& arguments);

}  // namespace dinal::prompt
