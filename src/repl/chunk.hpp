// What is typed at the prompt, compiled: an expression to a function that returns its values, else as statements.
#pragma once

#include <lua.hpp>

#include <string>

namespace dinal {

enum class Compiled {
    ready,       ///< the function is on the top of the stack
    incomplete,  ///< more lines are needed; the message is what to say when none come
    wrong,       ///< the message is
};

/// The name of every such chunk, in messages "stdin", as in lua.
inline constexpr const char* prompt_chunk = "=stdin";

Compiled compile(lua_State* L, const std::string& text);

}  // namespace dinal
