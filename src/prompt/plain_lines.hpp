// Lines typed by the user, read without an editor, and the word about Ctrl-C while a line is read.
#pragma once

#include <csignal>
#include <string>

namespace dinal::prompt {

enum class Reading {
    line,
    end,          ///< Ctrl-D, or the end of a file
    interrupted,  ///< Ctrl-C
};

struct TypedLine {
    Reading reading = Reading::end;
    std::string text;  ///< without its newline; a pasted block has newlines inside
};

TypedLine read_plain(const std::string& prompt);

/// While it lives, Ctrl-C belongs to the line that is typed, and to nobody else. One at a time.
class InterruptNote {
public:
    InterruptNote();
    ~InterruptNote();
    InterruptNote(const InterruptNote&) = delete;
    InterruptNote& operator=(const InterruptNote&) = delete;

    [[nodiscard]] static bool interrupted();

private:
    struct sigaction before_ {};
};

}  // namespace dinal::prompt
