// The prompt: reads a chunk of Lua, runs it, shows its values, and goes on whatever happens.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

/// The first line of a session.
std::string greeting();

enum class Start { with_init_file, plain };

/// Until the end of input. False when Ctrl-C ended it, which happens only where no terminal is.
bool run_prompt(lua_State* L, Start start);

}  // namespace dinal::prompt
