// Lines typed by the user: with GNU readline at a terminal if available, otherwise plain.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "prompt/plain_lines.hpp"

namespace dinal::prompt {

/// Only one may exist. Lua code may read standard input between two lines.
class LineEditor {
public:
    /// Uses the state for completion and signatures.
    explicit LineEditor(lua_State* L);

    /// Reads a line. `pending` are the previous lines of an unfinished chunk, `cue` is its missing part, shown in grey.
    [[nodiscard]] TypedLine read(const std::string& prompt, const std::string& pending = "",
                                 const std::string& cue = "") const;

    /// Adds an entry, possibly of several lines, to the history of this and later sessions.
    void remember(const std::string& entry);

    /// For --version: the line editor and its effect on the program's licence.
    static const char* about();

private:
    [[maybe_unused]] bool edits_;  // whether readline is used
    std::string history_file_;     // empty: history is not kept
};

}  // namespace dinal::prompt
