// What the other end of an output can show: how wide it is, which characters and whether colours.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::terminal {

struct Display {
    std::size_t width = 80;
    bool unicode = true;  ///< UTF-8, else ASCII
    bool colour = false;  ///< a terminal that knows colours, and no NO_COLOR
    bool terminal = false;
};

/// As it is now: a terminal may have got another size. What is no terminal is 80 columns wide.
Display display_of(int descriptor);

/// The terminal obeys escape sequences: TERM is set, and not to "dumb".
bool obeys_escapes();

/// Our own text for a screen: the few letters beyond ASCII that we use (…, θ, ω) are spelled out when it must be so.
std::string spelled(std::string_view text, const Display& screen);

/// Columns that UTF-8 text takes on a terminal; what is not UTF-8 takes one for each byte that begins a character.
std::size_t columns(std::string_view text);

/// Bytes of the printable character that begins the text; 0 when it is a control character or not UTF-8.
std::size_t printable_length(std::string_view text);

/// One line that is safe to show: blanks for white space, `?` for what can not be printed.
std::string printable(std::string_view line, const Display& screen);

/// Words in lines of at most `width` columns; newlines in the text stay. A line that begins with a blank is laid out
/// already, and stays as it is.
std::string wrapped(std::string_view text, std::size_t width);

}  // namespace dinal::terminal
