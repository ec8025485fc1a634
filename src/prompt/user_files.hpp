// The files that belong to the user and not to his work: the history of the prompt, and what it begins with.
#pragma once

#include <string>

namespace dinal::prompt {

/// ${XDG_STATE_HOME:-~/.local/state}/dinal/NAME, made (for this user only) with its folders if it is missing; empty if
/// that is not possible. `history` is that of the prompt, `lab-tries` keeps the wrong values of the lab.
std::string state_file(const char* name);

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/init.lua, run before the first prompt; empty when it is not there.
std::string init_file();

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/lab-course.lua, which instructors have; empty when there is no such folder.
std::string lab_course_file();

}  // namespace dinal::prompt
