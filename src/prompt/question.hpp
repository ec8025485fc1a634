// ?name and name? at the prompt: help, by what the name stands for now, else by the name itself.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// A line that begins or ends with a question mark, which Lua does not have.
bool is_question(std::string_view line);

/// The help for what stands in the line, which ends with a line end.
std::string answer_to(lua_State* L, std::string_view line);

}  // namespace dinal::prompt
