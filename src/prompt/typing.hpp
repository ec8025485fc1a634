// While a line is typed: the grey hint behind it, and completion that no error of Lua can leave.
#pragma once

#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "prompt/completion.hpp"

namespace dinal::prompt {

/// What draws the hint behind a line, and puts the cursor back.
struct Painted {
    std::string text;   ///< empty when the line must stay as it is
    bool hint = false;  ///< something stands behind the line now
};

/// The line stands behind the prompt on the row of the cursor.
struct LineOnScreen {
    std::string_view prompt;
    const std::string& pending;  ///< the lines before it of a chunk that goes on
    std::string_view line;
    std::size_t cursor = 0;  ///< a place in the line
    std::string_view cue;    ///< what the chunk waits for, where nothing is typed yet
    std::string_view rest;   ///< what history adds to the line
};
Painted paint(lua_State* L, const LineOnScreen& shown);

/// complete(), with an empty answer where memory runs out.
Completion complete_safely(lua_State* L, const std::string& before);

}  // namespace dinal::prompt
