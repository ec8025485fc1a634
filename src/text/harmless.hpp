// Text from outside, made safe to show on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// Keeps lines, tabs and colours; replaces all other control characters by '?'.
std::string harmless(std::string_view text);

}  // namespace dinal::text
