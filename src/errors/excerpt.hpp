// The line of source that an error is about, with a mark below it.
#pragma once

#include <string>
#include <vector>

#include "errors/source_text.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// The words of the source that an error may be about, the likeliest first.
std::vector<std::string> suspects(const text::Error& error);
std::vector<std::string> suspects(const lua::LuaMessage& message);

/// "\n  10 | x = sytem{}\n     |     ^^^^^", with the mark below the first of the suspects that stands there. Empty
/// when the line is not there, or was typed just now and no part of it is known to be the culprit.
std::string excerpt(const SourceText& source, int line, const std::vector<std::string>& suspects);

/// The same for a chunk that does not compile, with the message in that line.
std::string syntax_excerpt(lua_State* L, const SourceText& source, int line, const lua::SyntaxMessage& message);

}  // namespace dinal::errors
