// What the signature in a Doc says, for completion and hints: "sys:simulate{ M = 0, t_end, dt | times } -> run".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "help/library.hpp"

namespace dinal::help {

/// How a table of options is passed: f{ ... }, f(..., { ... }), or f{ { ... } }, as a curve of a plot.
enum class Braces { alone, in_parentheses, nested };

/// The whole signature: the options of the calls stand where the Doc says OPTIONS.
std::string signature(const lua::Doc& doc);

/// The call whose table of options is passed like this; nullptr when none is.
const text::Call* call_with(const lua::Doc& doc, Braces braces);

/// The calls of a Doc.
std::vector<const text::Call*> calls_of(const lua::Doc& doc);

/// An option as it is listed.
struct OptionLine {
    const char* option;
    std::string name;     ///< "dt", "theta0 = 0"
    std::string meaning;  ///< with its unit and its limits: "time from row to row (time units, must be positive)"
};
std::vector<OptionLine> option_lines(std::span<const text::Option> options);

/// "M = 0, t_end, dt | times"
std::string option_list(std::span<const text::Option> options);

/// What stands in the brackets of the call: "M = 0, t_end, dt | times".
std::string parameters(std::string_view signature);

/// The bracket that a call begins with: '{', '(', or ' ' when there is none.
char call_bracket(std::string_view signature);

/// The class of the object that a call gives, a field holds or a constructor makes; nullptr when it is none of ours.
const Section* result_class(std::string_view signature);

}  // namespace dinal::help
