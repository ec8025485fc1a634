// The only file that knows readline, and the only one that differs when it is not built in.
#include "repl/line_editor.hpp"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

#ifdef DINAL_READLINE
#include <poll.h>
#include <readline/history.h>
#include <readline/readline.h>

#include <cstring>
#endif

#include "repl/history_file.hpp"
#include "repl/output.hpp"

namespace dinal {
namespace {

volatile std::sig_atomic_t interrupted = 0;

extern "C" void note_interrupt(int) {
    interrupted = 1;
}

/// While it lives, Ctrl-C belongs to the line that is typed, and to nobody else.
class InterruptNote {
public:
    InterruptNote() {
        interrupted = 0;
        struct sigaction action {};
        action.sa_handler = note_interrupt;
        sigemptyset(&action.sa_mask);
        action.sa_flags = 0;  // no SA_RESTART: reading must wake up
        sigaction(SIGINT, &action, &before_);
    }
    ~InterruptNote() { sigaction(SIGINT, &before_, nullptr); }
    InterruptNote(const InterruptNote&) = delete;
    InterruptNote& operator=(const InterruptNote&) = delete;

private:
    struct sigaction before_ {};
};

Line read_plain(const std::string& prompt) {
    say(prompt);
    flush_output();
    const InterruptNote note;
    char* buffer = nullptr;
    std::size_t capacity = 0;
    // From the same FILE as io.read, so that Lua code can read the lines that follow its own.
    const ssize_t size = getline(&buffer, &capacity, stdin);
    std::string text(buffer == nullptr ? "" : buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
    std::free(buffer);  // NOLINT: getline allocated it
    if (interrupted != 0) {
        std::clearerr(stdin);
        say("\n");
        return {Reading::interrupted, ""};
    }
    if (size < 0) {
        std::clearerr(stdin);  // Ctrl-D ends this line, not all that may still be typed
        return {Reading::end, ""};
    }
    if (text.back() == '\n') {
        text.pop_back();
    }
    return {Reading::line, text};
}

#ifdef DINAL_READLINE

constexpr int longest_history = 5000;  // entries

bool accepted = false;  // these two are set by accept(), which readline calls when the line is finished
Line accepted_line;

void accept(char* text) {
    accepted = true;
    accepted_line = text == nullptr ? Line{} : Line{Reading::line, text};
    std::free(text);               // NOLINT: readline allocated it
    rl_callback_handler_remove();  // now, before readline prints another prompt
}

char* no_completion(const char*, int) {
    return nullptr;
}

bool dumb_terminal() {
    const char* name = std::getenv("TERM");  // NOLINT(concurrency-mt-unsafe): one thread
    return name == nullptr || *name == '\0' || std::strcmp(name, "dumb") == 0;
}

void start_readline(const std::string& history) {
    rl_readline_name = "dinal";
    rl_catch_signals = 1;                          // it restores the terminal before Ctrl-Z and its like take effect,
    rl_persistent_signal_handlers = 1;             // also when one comes while we wait for a key
    rl_completion_entry_function = no_completion;  // its own would offer names of files
    rl_initialize();
    // After the user's inputrc. A blinking parenthesis would swallow a Ctrl-C that is typed within its half second.
    rl_variable_bind("blink-matching-paren", "off");
    rl_variable_bind("enable-bracketed-paste", dumb_terminal() ? "off" : "on");
    // With time stamps an entry of several lines is read back as one.
    history_comment_char = '#';
    history_write_timestamps = 1;
    stifle_history(longest_history);
    if (!history.empty()) {
        history_truncate_file(history.c_str(), longest_history);
        read_history(history.c_str());
    }
}

/// Waits for a key or a signal, and lets readline see the signal. True when there is a key to read.
bool key_arrived() {
    bool arrived = false;
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    // All are blocked from the last look until ppoll sleeps, so that none is overlooked.
    sigprocmask(SIG_BLOCK, &all, &before);
    if (rl_pending_signal() == 0 && interrupted == 0) {
        pollfd input{fileno(rl_instream), POLLIN, 0};
        arrived = ppoll(&input, 1, nullptr, &before) > 0;
    }
    sigprocmask(SIG_SETMASK, &before, nullptr);
    rl_check_signals();  // raises the signal again for note_interrupt, with the terminal in order
    return arrived && interrupted == 0;
}

Line read_edited(const std::string& prompt) {
    const InterruptNote note;
    accepted = false;
    using_history();
    rl_callback_handler_install(prompt.c_str(), accept);
    while (!accepted) {
        if (key_arrived()) {
            rl_callback_read_char();
        }
        if (interrupted != 0 && !accepted) {
            rl_callback_sigcleanup();
            rl_free_line_state();
            rl_callback_handler_remove();
            say("\n");  // rl_outstream is standard output
            return {Reading::interrupted, ""};
        }
    }
    return accepted_line;
}

bool can_edit() {
    return isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0;
}

#endif

}  // namespace

#ifdef DINAL_READLINE

// NOTE: readline reads a pipe badly (it spins at its end and completes at its tabs): never use it there.
LineEditor::LineEditor() : edits_(can_edit()) {
    if (edits_) {
        history_file_ = history_file();
        start_readline(history_file_);
    }
}

Line LineEditor::read(const std::string& prompt) const {
    return edits_ ? read_edited(prompt) : read_plain(prompt);
}

void LineEditor::remember(const std::string& entry) {
    if (!edits_ || entry.find_first_not_of(" \t\n") == std::string::npos) {
        return;
    }
    const HIST_ENTRY* last = history_length > 0 ? history_get(history_base + history_length - 1) : nullptr;
    if (last != nullptr && entry == last->line) {
        return;
    }
    add_history(entry.c_str());
    if (!history_file_.empty()) {
        append_history(1, history_file_.c_str());  // at once: the session may end by a signal or os.exit
    }
}

const char* LineEditor::about() {
    return "Lines are edited with GNU Readline: this program may be distributed under the GNU GPL, version 3 or later.";
}

#else

LineEditor::LineEditor() : edits_(false) {}

Line LineEditor::read(const std::string& prompt) const {
    return read_plain(prompt);
}

void LineEditor::remember(const std::string&) {}

const char* LineEditor::about() {
    return "Built without GNU Readline: this program is under the MIT licence, too.";
}

#endif

}  // namespace dinal
