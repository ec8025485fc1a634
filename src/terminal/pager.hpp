// Long texts, shown on a terminal page by page.
#pragma once

#include <string_view>

namespace dinal::terminal {

/// Writes the text on standard output. If that is an interactive terminal too low for the text, it stops at the end of
/// each page: Space and Enter continue, any other key ends the output. PAGER=cat never stops.
void show_in_pages(std::string_view text);

/// Returns the key that ended the last text if it was meant for the prompt: any key except q, Escape and Ctrl-C.
/// Returns it once, and '\0' if there is none.
char key_left_over();

}  // namespace dinal::terminal
