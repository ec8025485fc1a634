// What others have written, made so that it cannot steer the terminal that shows it.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// The text with its lines, tabs and colours, and '?' for all else that steers a terminal.
std::string harmless(std::string_view text);

}  // namespace dinal::text
