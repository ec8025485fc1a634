// Lines typed by the user, read without an editor, and the word about Ctrl-C while a line is read.
#pragma once

#include <csignal>

#include <optional>
#include <string>
#include <string_view>

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

/// What stands behind a prompt that was copied along with it, of this program or of others: "> x", ">> x", "dinal> x",
/// "In [1]: x". None when there is no prompt in front.
std::optional<std::string_view> behind_prompt(std::string_view line);

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
