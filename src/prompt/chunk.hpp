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

}  // namespace dinal::prompt
