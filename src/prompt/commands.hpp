// The commands of the prompt, `:help` and its like. Such a line is never valid Lua.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "prompt/completion.hpp"

namespace dinal::prompt {

struct Session;

/// A line that begins with a colon (but ::label:: is Lua) or with a question mark, or ends with one.
bool is_command(std::string_view line);

void run_command(Session& session, const std::string& line);

/// Tab in a line that begins with a colon.
Completion complete_command(lua_State* L, std::string_view before);

}  // namespace dinal::prompt
