// Lines typed by the user: with GNU readline at a terminal if available, otherwise plain.
#pragma once

#include <csignal>
#include <optional>
#include <string>
#include <string_view>

#include "lua/lua_headers.hpp"
#include "text/not_copied.hpp"

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
class InterruptNote : text::NotCopied {
public:
    InterruptNote();
    ~InterruptNote();

    [[nodiscard]] static bool interrupted();

private:
    struct sigaction before_ {};
};

/// Only one may exist. Lua code may read standard input between two lines.
class LineEditor {
public:
    /// Uses the state for completion and signatures.
    explicit LineEditor(lua_State* L);

    /// Reads a line. `pending` are the previous lines of an unfinished chunk, `cue` is its missing part, shown in grey.
    TypedLine read(const std::string& prompt, const std::string& pending = "", const std::string& cue = "") const;

    /// Adds an entry, possibly of several lines, to the history of this and later sessions.
    void remember(const std::string& entry);

    /// For --version: the line editor and its effect on the program's licence.
    static const char* about();

private:
    [[maybe_unused]] bool edits_;  // whether readline is used
    std::string history_file_;     // empty: history is not kept
};

}  // namespace dinal::prompt
