// Lines typed by the user: with GNU readline at a terminal when it is built in, else plain.
#pragma once

#include <string>

namespace dinal {

enum class Reading {
    line,
    end,          ///< Ctrl-D, or the end of a file
    interrupted,  ///< Ctrl-C
};

struct Line {
    Reading reading = Reading::end;
    std::string text;  ///< without its newline; a pasted block has newlines inside
};

/// One lives at a time. Lua code may read standard input between two lines.
class LineEditor {
public:
    LineEditor();

    [[nodiscard]] Line read(const std::string& prompt) const;

    /// Adds an entry, which may have several lines, to the history of this and of later sessions.
    void remember(const std::string& entry);

    /// For --version: what edits the lines and what that means for the licence of the program.
    static const char* about();

private:
    bool edits_;                // readline, not plain reading
    std::string history_file_;  // empty when there is none
};

}  // namespace dinal
