// Habits from other languages and decimal commas, with the Lua equivalents.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// The end of a sentence about a chunk that does not compile, "; comparing is ==", or "". `statement` contains the
/// error.
std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement);

/// The occasion to look for tokens of other languages: in a chunk that does not compile, first, last if nothing else
/// explains it, or where an expression continues; or in a running chunk.
enum class Seen { first, last, between, running };

/// The same for these tokens of other languages, whatever the message: v[1:3], f"{x}", lambda x.
std::string foreign_tokens(std::string_view statement, Seen seen);

/// The same for a run-time error.
std::string running_habit(const text::Error& error, std::string_view statement);
std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

/// The replacement of a global name from other languages, "; did you mean 'print'?", or "".
std::string foreign_name(std::string_view name);

}  // namespace dinal::errors
