// Compiles prompt input: statements, followed by an optional expression whose values are shown.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::prompt {

enum class Compiled {
    ready,       ///< the function is on the top of the stack
    incomplete,  ///< more lines are needed; the message on the stack applies if none come
    wrong,       ///< the message is on the top of the stack
};

struct Chunk {
    Compiled result = Compiled::wrong;
    std::string statements;  ///< executed first
    std::string expression;  ///< returned by the function; may be empty
    bool silent = false;     ///< whether a final `;` suppresses the values
    std::string waits = {};  ///< if incomplete: "'for' of line 1 waits for 'end'"
};

/// The chunk name of prompt input, which begins messages: "input:1: ...".
inline constexpr const char* prompt_chunk = "=input";

Chunk compile(lua_State* L, const std::string& text);

/// Returns whether the chunk only reads a variable, so that ans is kept.
bool only_reads_variable(const Chunk& chunk);

// Running a chunk and showing its values.

struct Evaluated {
    bool fine = false;       ///< whether there was no error and no Ctrl-C
    int values = 0;          ///< number of returned values
    bool first_nil = false;  ///< whether the first value is nil, so that ans is kept
};

/// All values on the stack as the prompt shows them. Requires call().
std::string values_text(lua_State* L);

/// Prints its arguments on the terminal.
int print_values(lua_State* L);

/// Runs the function on the top of the stack, described by `chunk`, and empties the stack. `show_values` shows the
/// results, the first of which becomes the global ans; errors are reported. After an error in a run, ans is the partial
/// run.
Evaluated evaluate(lua_State* L, const Chunk& chunk, lua_CFunction show_values = print_values);

}  // namespace dinal::prompt
