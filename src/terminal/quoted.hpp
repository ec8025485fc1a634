// Text made fit for a terminal line: quoted, escaped, cut.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace dinal::terminal {

/// "..." with Lua's escapes for quotes, control characters and bytes that are not UTF-8; at most `limit` bytes of the
/// text are shown, and `...` stands for the rest. Without `unicode`, all but ASCII is escaped.
std::string quoted(std::string_view text, std::size_t limit, bool unicode);

}  // namespace dinal::terminal
