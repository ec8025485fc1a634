// The abilities of a terminal or another output: its width, its characters and its colours;
// long texts are shown on it page by page.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::terminal {

struct Display {
    std::size_t width = 80;  ///< columns for text, at least 20
    bool unicode = true;     ///< whether it shows UTF-8; otherwise only ASCII
    bool colour = false;     ///< whether it is a terminal with colours and NO_COLOR is not set
    bool terminal = false;
    bool draws = true;  ///< whether it shows bars and braille: UTF-8, and TERM is not "dumb"
    int columns = 80;   ///< the width of the window, however narrow
    int rows = 24;
};

/// The present abilities (the window may have been resized). An output that is no terminal counts as 80 columns wide.
Display display_of(int descriptor);

/// Returns whether the terminal obeys escape sequences: TERM is set, and not to "dumb".
bool obeys_escapes();

/// Spells out Greek letters and the like if the screen cannot show them; for text of dinal itself.
std::string spelled(std::string_view text, const Display& screen);

/// Writes the text on standard output. If that is an interactive terminal too low for the text, it stops at the end of
/// each page: Space and Enter continue, any other key ends the output. PAGER=cat never stops.
void show_in_pages(std::string_view text);

/// Returns the key that ended the last text if it was meant for the prompt: any key except q, Escape and Ctrl-C.
/// Returns it once, and '\0' if there is none.
char key_left_over();

}  // namespace dinal::terminal
