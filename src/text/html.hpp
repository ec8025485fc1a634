// Text that a browser shows as it stands.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// & < > " ' become entities; control characters but for tab and line end, which no page may have, what turns the
/// direction of writing round, and what is no UTF-8 become U+FFFD.
std::string html(std::string_view text);

/// For Markdown: & < > become entities, since not every reader takes \< for text; a backslash comes before each of the
/// `marks`.
std::string markdown(std::string_view text, std::string_view marks);

}  // namespace dinal::text
