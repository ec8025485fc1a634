// Long texts, shown on a terminal page by page.
#pragma once

#include <string_view>

namespace dinal::terminal {

/// Writes the text on standard output. Where that is a terminal with somebody at its keys, and too low for the text, it
/// stops at the end of each page: Space and Enter go on, q ends it. PAGER=cat never stops.
void show_in_pages(std::string_view text);

}  // namespace dinal::terminal
