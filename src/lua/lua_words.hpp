// Lua text as far as it takes to find where its functions begin and end.
#pragma once

#include <string_view>
#include <vector>

namespace dinal {

/// The functions in a text that compiles, from the word `function` to their `end`, that begin on one line and end on
/// the other (counted from 1).
std::vector<std::string_view> functions_between(std::string_view text, int first_line, int last_line);

}  // namespace dinal
