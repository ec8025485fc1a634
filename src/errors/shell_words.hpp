// What people type who are used to a shell, to a notebook, or to another language than English.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// What to do instead of that word, alone on a line: ":quit or Ctrl-D leaves"; "" for other words.
std::string_view instead_of_word(std::string_view word);

/// What to do instead of a line that is one for a shell, such as "ls -la" or "dinal lab.lua"; "" for other lines. To be
/// asked about lines only that are wrong, or not complete.
std::string instead_of_shell_line(lua_State* L, std::string_view line);

}  // namespace dinal::errors
