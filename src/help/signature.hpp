// What the signature in a Doc says, for completion and hints: "sys:simulate{ M = 0, t_end, dt | times } -> run".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"

namespace dinal::help {

/// How a table of options is passed: f{ ... }, f(..., { ... }), or f{ { ... } }, as a curve of a plot.
enum class Braces { alone, in_parentheses, nested };

/// The names of the options: M, t_end, dt, times.
std::vector<std::string> option_names(std::string_view signature, Braces braces);

/// What stands in the brackets of the call: "M = 0, t_end, dt | times".
std::string parameters(std::string_view signature);

/// The bracket that a call begins with: '{', '(', or ' ' when there is none.
char call_bracket(std::string_view signature);

/// The class of the object that a call gives, a field holds or a constructor makes; nullptr when it is none of ours.
const Section* result_class(std::string_view signature);

}  // namespace dinal::help
