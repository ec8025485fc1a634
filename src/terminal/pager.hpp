// Long texts, shown on a terminal page by page.
#pragma once

#include <string_view>

namespace dinal::terminal {

/// Writes the text on standard output. Where that is a terminal with somebody at its keys, and too low for the text, it
/// stops at the end of each page: Space and Enter go on, any other key ends it. PAGER=cat never stops.
void show_in_pages(std::string_view text);

/// The key that ended the last text, if it was meant for the prompt: any key except q, Escape and Ctrl-C. '\0' for
/// none; it is returned once.
char key_left_over();

}  // namespace dinal::terminal
