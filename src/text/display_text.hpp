// A user's words on their way into a picture: what can be shown of them, and how wide that is on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::text {

/// One line of valid UTF-8: control characters become blanks, what is no UTF-8 becomes U+FFFD.
std::string displayable(std::string_view text);

/// The columns it takes on a terminal; the text must be displayable.
std::size_t display_width(std::string_view text);

/// The longest beginning that takes at most `width` columns.
std::string_view cut_to_width(std::string_view text, std::size_t width);

/// For a terminal without UTF-8: Greek letters by name, other letters as '?'.
std::string in_ascii(std::string_view text);

}  // namespace dinal::text
