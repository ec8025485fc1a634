// The line of source that an error is about, with a mark below it.
#pragma once

#include <string>
#include <string_view>

#include "errors/source_text.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// "\n  10 | x = sytem{}\n     |     ^^^^^". The mark is found by the names in the message, or in the suggestion of
/// help_with(). Empty when the line is not there, or was typed just now and no part of it is known to be the culprit.
std::string excerpt(const SourceText& source, const Message& message, std::string_view suggestion);

/// The same for a chunk that does not compile.
std::string syntax_excerpt(lua_State* L, const SourceText& source, const Message& message);

}  // namespace dinal::errors
