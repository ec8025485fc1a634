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

// ?name and name? at the prompt: help, by what the name stands for now, else by the name itself.

/// A line that begins or ends with a question mark, which Lua does not have.
bool is_question(std::string_view line);

/// The help for what stands in the line, which ends with a line end.
std::string answer_to(lua_State* L, std::string_view line);

}  // namespace dinal::prompt
