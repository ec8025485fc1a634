// Where the history of the prompt is kept.
#pragma once

#include <string>

namespace dinal {

/// ${XDG_STATE_HOME:-~/.local/state}/dinal/history, made (for this user only) with its folders when it is not there;
/// empty when that is not possible: the prompt works without a history.
std::string history_file();

}  // namespace dinal
