// The commands of the prompt, such as `:help`. A command is never valid Lua.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "prompt/completion.hpp"

namespace dinal::prompt {

struct Session;

/// Returns whether the line begins with a colon (but ::label:: is Lua), or begins or ends with a question mark.
bool is_command(std::string_view line);

void run_command(Session& session, const std::string& line);

/// Completion of a line that begins with a colon.
Completion complete_command(lua_State* L, std::string_view before);

// ?name and name? at the prompt: help on the present value of the name, otherwise on the name.

/// Returns whether the line begins or ends with a question mark, which Lua does not use.
bool is_question(std::string_view line);

/// The help for the question in the line, with a final newline.
std::string answer_to(lua_State* L, std::string_view line);

}  // namespace dinal::prompt
