// What is typed at the prompt, compiled: statements, and an expression at their end whose values are shown.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

enum class Compiled {
    ready,       ///< the function is on the top of the stack
    incomplete,  ///< more lines are needed; the message is what to say when none come
    wrong,       ///< the message is
};

struct Chunk {
    Compiled result = Compiled::wrong;
    std::string statements;  ///< what is run first
    std::string expression;  ///< whose values the function returns; empty when there is none
    bool silent = false;     ///< a `;` stands behind the expression: its values are not to be shown
    std::string waits = {};  ///< of an incomplete one: "'for' of line 1 waits for 'end'"
};

/// The name of every such chunk in messages: "input:1: ...".
inline constexpr const char* prompt_chunk = "=input";

Chunk compile(lua_State* L, const std::string& text);

/// It only names a variable, to look at it: ans stays what it was.
bool only_looks(const Chunk& chunk);

// Runs what was typed, and shows what comes of it.

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
