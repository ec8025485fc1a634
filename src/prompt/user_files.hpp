// The files that belong to the user and not to his work: the history of the prompt, and what it begins with.
#pragma once

#include <string>

namespace dinal::prompt {

/// ${XDG_STATE_HOME:-~/.local/state}/dinal/history, made (for this user only) with its folders when it is not there;
/// empty when that is not possible: the prompt works without a history.
std::string history_file();

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/init.lua, run before the first prompt; empty when it is not there.
std::string init_file();

/// ${XDG_CONFIG_HOME:-~/.config}/dinal/lab-course.lua, which instructors have; empty when there is no such folder.
std::string lab_course_file();

}  // namespace dinal::prompt
