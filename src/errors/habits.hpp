// Habits from other languages and decimal commas, with the Lua equivalents.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"
#include "text/expected.hpp"

namespace dinal::errors {

/// The end of a sentence about a chunk that does not compile, "; comparing is ==", or "". `statement` contains the
/// error.
std::string syntax_habit(lua_State* L, const lua::SyntaxMessage& message, std::string_view statement);

/// When words and signs of other languages are looked for: in a chunk that does not compile (first, last if nothing
/// else explains the error, or between two expressions); in a running chunk, also around a number, name or function of
/// safe mode at fault; in what Lua says; in an unknown name, or in one typed at the prompt; in an unfinished or a
/// complete input that compiles.
enum class Seen { first, last, between, running, number, named, safe, said, unknown, typed, unfinished, complete };

/// The remark on such words and signs, whatever the message: v[1:3], f"{x}", lambda x, disp. If there is a culprit, it
/// must be one of them.
std::string foreign_tokens(std::string_view statement, Seen seen, std::optional<std::string_view> culprit = {});

/// The remark on a run-time error.
std::string running_habit(const text::Error& error, std::string_view statement);
std::string running_habit(lua_State* L, const lua::LuaMessage& message, std::string_view statement);

}  // namespace dinal::errors
