// UTF-8 text for a terminal: printable characters, widths and line breaks; text from outside, made safe to
// show on it, in a browser or in Markdown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::text {

/// Returns the columns of a text on a terminal. Control characters and bytes that are not UTF-8 count as one column.
std::size_t columns(std::string_view text);

/// Returns the longest beginning of at most `width` columns.
std::string_view cut_to_columns(std::string_view text, std::size_t width);

/// Returns whether the text is valid UTF-8 without characters that control a terminal, except newlines.
bool is_printable(std::string_view text);

/// Returns one line of valid UTF-8: white space and direction marks become blanks, other control characters '?',
/// invalid bytes U+FFFD.
std::string displayable(std::string_view text);

/// Returns text for a terminal without UTF-8: Greek letters by name, other letters as '?'.
std::string in_ascii(std::string_view text);

/// Returns the text as a Lua string literal "..." that Lua reads back as the same bytes. Shows at most `limit` bytes,
/// followed by `...`. Without `unicode`, everything except ASCII is escaped.
std::string quoted(std::string_view text, std::size_t limit = std::string_view::npos, bool unicode = true);

inline constexpr std::size_t readable_width = 79;  ///< longer lines are hard to read, however wide the screen is

/// Wraps words into lines of at most `width` columns. Newlines stay; lines that begin with a blank are already laid out
/// and stay. Short formulas such as "theta = 0.155" are not broken.
std::string wrapped(std::string_view text, std::size_t width = readable_width);

/// Indents all lines except the first.
std::string indented(std::string text, std::size_t blanks);

/// For a terminal: keeps lines, tabs and colours; replaces all other control characters by '?'.
std::string harmless(std::string_view text);

/// For a browser, which shows it unchanged: & < > " ' become entities. Control characters except tab and newline,
/// direction marks and bytes that are not UTF-8 become U+FFFD.
std::string html(std::string_view text);

/// For Markdown: & < > become entities, as some readers do not know \<; the `marks` get a backslash.
std::string markdown(std::string_view text, std::string_view marks);

}  // namespace dinal::text
