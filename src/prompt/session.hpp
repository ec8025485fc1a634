// What one session at the prompt remembers, and what it does with a text that was typed.
#pragma once

#include <string>
#include <vector>

#include "lua/lua_headers.hpp"
#include "prompt/line_editor.hpp"
#include "prompt/record.hpp"

namespace dinal::prompt {

struct Session {
    explicit Session(lua_State* state) : L(state), editor(state) {}

    lua_State* L;
    LineEditor editor;
    Record record;
    lua_CFunction show_values = print_values;
    std::vector<std::string> inputs;  ///< what was typed, commands left out: for :history and :edit
    bool leaving = false;             ///< :quit
};

/// Compiles and runs a text that is all there is to come, as at the prompt. False after an error, which was told.
bool run_text(Session& session, const std::string& text);

/// Runs the function on the top of the stack, which `chunk` describes. False after an error, which was told.
bool run_chunk(Session& session, const Chunk& chunk, const std::string& text);

}  // namespace dinal::prompt
