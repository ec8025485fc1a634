// Escapes text so that a browser shows it unchanged.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// & < > " ' become entities. Control characters except tab and newline, direction marks and bytes that are not UTF-8
/// become U+FFFD.
std::string html(std::string_view text);

/// For Markdown: & < > become entities, as some readers do not know \<; the `marks` get a backslash.
std::string markdown(std::string_view text, std::string_view marks);

}  // namespace dinal::text
