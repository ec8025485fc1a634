// What people write who know other languages, or other decimal marks, and what to write instead.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// The end of a sentence about a chunk that does not compile, "; comparing is ==", or "". `statement` is where the
/// parser stumbled.
std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement);

/// When tokens of other languages are looked for: in a chunk that does not compile, first, when nothing else explains
/// it, or then where an expression goes on; or in one that compiles and fails when it runs.
enum class Seen { first, last, between, running };

/// The same for what other languages write in these tokens, whatever Lua complains of: v[1:3], f"{x}", lambda x.
std::string foreign_tokens(std::string_view statement, Seen seen);

/// The same for an error of a chunk that ran.
std::string running_habit(const text::Error& error, std::string_view statement);
std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

/// What to write instead of a global name that other languages have, "; did you mean 'print'?", or "".
std::string foreign_name(std::string_view name);

}  // namespace dinal::errors
