// Text from outside, made safe to show on a terminal, in a browser or in Markdown.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// For a terminal: keeps lines, tabs and colours; replaces all other control characters by '?'.
std::string harmless(std::string_view text);

/// For a browser, which shows it unchanged: & < > " ' become entities. Control characters except tab and newline,
/// direction marks and bytes that are not UTF-8 become U+FFFD.
std::string html(std::string_view text);

/// For Markdown: & < > become entities, as some readers do not know \<; the `marks` get a backslash.
std::string markdown(std::string_view text, std::string_view marks);

}  // namespace dinal::text
