// Text that a browser shows as it stands.
#pragma once

#include <string>
#include <string_view>

namespace dinal::text {

/// & < > " ' become entities; control characters but for tab and line end, which no page may have, what turns the
/// direction of writing round, and what is no UTF-8 become U+FFFD.
std::string html(std::string_view text);

}  // namespace dinal::text
