// UTF-8 text for a terminal: what can be shown of a user's words, how wide that is, and where its lines are broken.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::text {

/// The columns it takes on a terminal. A byte that is no UTF-8 and a control character count as one.
std::size_t columns(std::string_view text);

/// The longest beginning that takes at most `width` columns.
std::string_view cut_to_columns(std::string_view text, std::size_t width);

/// No byte of it steers a terminal or is no UTF-8; newlines may be in it.
bool is_printable(std::string_view text);

/// One line of valid UTF-8: blanks for white space and for what steers the direction of writing, '?' for other control
/// characters, U+FFFD for what is no UTF-8.
std::string displayable(std::string_view text);

/// For a terminal without UTF-8: Greek letters by name, other letters as '?'.
std::string in_ascii(std::string_view text);

/// "..." with Lua's escapes for quotes, control characters and what is no UTF-8, so that Lua reads the same bytes from
/// it; at most `limit` bytes are shown, and `...` stands for the rest. Without `unicode`, all but ASCII is escaped.
std::string quoted(std::string_view text, std::size_t limit = std::string_view::npos, bool unicode = true);

inline constexpr std::size_t readable_width = 79;  ///< longer lines are hard to read, however wide the screen is

/// Words in lines of at most `width` columns; newlines in the text stay. A line that begins with a blank is laid out
/// already, and stays as it is. A short formula is broken nowhere: "theta = 0.155".
std::string wrapped(std::string_view text, std::size_t width = readable_width);

/// All lines but the first moved to the right.
std::string indented(std::string text, std::size_t blanks);

}  // namespace dinal::text
