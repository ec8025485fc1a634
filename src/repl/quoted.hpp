// Text made fit for a terminal line: quoted, escaped, cut.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal {

/// "..." with Lua's escapes for quotes, control characters and bytes that are not UTF-8; at most `limit` bytes of the
/// text are shown, and `...` stands for the rest.
std::string quoted(std::string_view text, std::size_t limit);

/// Several lines of nothing but printable characters: a text to be read as it is, without quotes.
bool is_lines(std::string_view text);

/// Columns that UTF-8 text takes on a terminal, taking every character for one column wide.
std::size_t columns(std::string_view text);

}  // namespace dinal
