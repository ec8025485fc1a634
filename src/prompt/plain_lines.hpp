// Lines typed by the user, read without an editor, and the handling of Ctrl-C meanwhile.
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

/// The text after a copied prompt of this or another program: "> x", ">> x", "dinal> x", "In [1]: x". None without a
/// prompt.
std::optional<std::string_view> behind_prompt(std::string_view line);

TypedLine read_plain(const std::string& prompt);

/// While this object lives, Ctrl-C only affects the line being typed. Only one may exist.
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
