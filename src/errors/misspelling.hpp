// Names that were probably meant: for an error that follows a nil where the user expected something.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "errors/source_text.hpp"
#include "lua/lua_headers.hpp"

namespace dinal::errors {

/// The end of a sentence about an error: "; did you mean 'system'?" or what else helps with it, or "". `frame` is where
/// it happened, nullptr when that is gone; `statement` its text, as far as it is known.
std::string help_with(lua_State* L, lua_Debug* frame, std::string_view words, std::string_view statement);

/// The global names that a misspelt one may stand for, as the end of a sentence.
std::string similar_global(lua_State* L, std::string_view name);

/// The names that may be written after a variable of that name and a dot: raw keys, those of its __index tables, and
/// members. Runs no code of the user. The value is on the top of the stack.
std::vector<std::string> member_names(lua_State* L);

}  // namespace dinal::errors
