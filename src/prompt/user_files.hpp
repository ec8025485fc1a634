// The user's personal files: history, settings, lab tries.
#pragma once

#include <string>

namespace dinal::prompt {

/// ${XDG_STATE_HOME:-~/.local/state}/dinal/NAME, created with its folders for this user only if missing; empty if that
/// fails. `history` is for the prompt, `lab-tries` has the wrong values of the lab.
std::string state_file(const char* name);

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/init.lua, run before the first prompt; empty if it does not exist.
std::string init_file();

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/lab-course.lua for instructors; empty without the folder.
std::string lab_course_file();

}  // namespace dinal::prompt
