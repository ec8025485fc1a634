// The map of the Lua API, from which everything is registered and listed in the manual, and the
// signatures in it, parsed for completion and hints: "sys:simulate{ M = 0, t_end, dt | times } -> run".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lua/bind.hpp"

namespace dinal::help {

/// Makes the table `dinal` (also for require "dinal"), copies its members to _G and tracks coroutines for Ctrl-C.
void open_library(lua_State* L);

using lua::Section;
/// All sections of the API in the order of the manual.
std::span<const Section> sections();

/// The way a table of options is passed: f{ ... }, f(..., { ... }), or f{ { ... } } as for a curve of a plot.
enum class Braces { alone, in_parentheses, nested };

/// The whole signature, with the options of the calls in place of OPTIONS.
std::string signature(const lua::Doc& doc);

/// The call whose options are passed in this way, or nullptr.
const text::Call* call_with(const lua::Doc& doc, Braces braces);

std::vector<const text::Call*> calls_of(const lua::Doc& doc);

/// An option for a list.
struct OptionLine {
    const char* option;
    std::string name;     ///< "dt", "theta0 = 0"
    std::string meaning;  ///< with unit and limits: "time from row to row (time units, must be positive)"
};
std::vector<OptionLine> option_lines(std::span<const text::Option> options);

/// "M = 0, t_end, dt | times"
std::string option_list(std::span<const text::Option> options);

/// The text in the brackets of the call: "M = 0, t_end, dt | times".
std::string parameters(std::string_view signature);

/// The opening bracket of the call: '{', '(', or ' ' for none.
char call_bracket(std::string_view signature);

/// The section of the class of a call's result, of a field or of a constructor; nullptr for other types.
const Section* section_of_result(std::string_view signature);

}  // namespace dinal::help
