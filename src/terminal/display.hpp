// What the other end of an output can show: how wide it is, which characters and whether colours.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::terminal {

struct Display {
    std::size_t width = 80;  ///< for text: 20 at least
    bool unicode = true;     ///< UTF-8, else ASCII
    bool colour = false;     ///< a terminal that knows colours, and no NO_COLOR
    bool terminal = false;
    bool draws = true;  ///< bars and braille: UTF-8, and no dumb terminal
    int columns = 80;   ///< of the window, however narrow
    int rows = 24;
};

/// As it is now: a terminal may have got another size. What is no terminal is 80 columns wide.
Display display_of(int descriptor);

/// The terminal obeys escape sequences: TERM is set, and not to "dumb".
bool obeys_escapes();

/// Our own text for a screen: Greek letters and the like are spelled out when it must be so.
std::string spelled(std::string_view text, const Display& screen);

}  // namespace dinal::terminal
