// What people write who know other languages, or other decimal marks, and what to write instead.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// The end of a sentence about a chunk that does not compile, "; comparing is ==", or "". `statement` is where the
/// parser stumbled.
std::string syntax_habit(lua_State* L, std::string_view words, std::string_view statement);

/// The same for an error of a chunk that ran.
std::string running_habit(std::string_view words, std::string_view statement);

/// What to write instead of a global name that other languages have, "; did you mean 'print'?", or "".
std::string foreign_name(std::string_view name);

}  // namespace dinal::errors
