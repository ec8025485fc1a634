// Lines typed by the user: with GNU readline at a terminal when it is built in, else plain.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "prompt/plain_lines.hpp"

namespace dinal::prompt {

/// One lives at a time. Lua code may read standard input between two lines.
class LineEditor {
public:
    /// The state is asked for names at Tab and for signatures.
    explicit LineEditor(lua_State* L);

    /// `pending` are the lines before it of a chunk that goes on, `cue` says in grey what it waits for.
    [[nodiscard]] TypedLine read(const std::string& prompt, const std::string& pending = "",
                                 const std::string& cue = "") const;

    /// Adds an entry, which may have several lines, to the history of this and of later sessions.
    void remember(const std::string& entry);

    /// For --version: what edits the lines and what that means for the licence of the program.
    static const char* about();

private:
    [[maybe_unused]] bool edits_;  // readline, not plain reading
    std::string history_file_;     // empty when there is none
};

}  // namespace dinal::prompt
