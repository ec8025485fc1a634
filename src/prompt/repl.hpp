// The prompt: reads a chunk of Lua, runs it, shows its values, and continues after errors.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// The first line of a session.
std::string greeting();

enum class Start { with_init_file, plain };

/// Runs until the end of input. Returns false if Ctrl-C ended it, possible only without a terminal.
bool run_prompt(lua_State* L, Start start);

}  // namespace dinal::prompt
