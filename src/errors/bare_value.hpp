// A value that stands alone on a line of a script, as it may at the prompt.
#pragma once

#include <string>

#include "errors/source_text.hpp"
#include "lua/lua_headers.hpp"
#include "lua/lua_message.hpp"

namespace dinal::errors {

/// "; a value alone is not a statement: print(6*7) shows it", for the line of the error or the one before it; or "".
std::string bare_value(lua_State* L, const SourceText& source, int line, const lua::SyntaxMessage& message);

}  // namespace dinal::errors
