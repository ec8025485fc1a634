// Runs what was typed, and shows what comes of it.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "prompt/chunk.hpp"

namespace dinal::prompt {

struct Evaluated {
    bool fine = false;       ///< no error, no Ctrl-C
    int values = 0;          ///< how many it returned
    bool first_nil = false;  ///< the first of them is nil, which ans does not become
};

/// All values on the stack, as the prompt shows them. Within call() only.
std::string values_text(lua_State* L);

/// Shows the values that are its arguments on the terminal.
int print_values(lua_State* L);

/// Runs the function on the top of the stack, which `chunk` describes, and empties the stack. Its values are shown by
/// the function that is given, the first becomes the global ans; an error is told. After an error in a run, ans is what
/// was done of it.
Evaluated evaluate(lua_State* L, const Chunk& chunk, lua_CFunction show_values = print_values);

}  // namespace dinal::prompt
