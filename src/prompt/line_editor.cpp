// The code that uses readline, and its replacement without readline.
#include "prompt/line_editor.hpp"

#ifdef DINAL_READLINE
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string_view>
#include <system_error>
#include <vector>

#include "files/file.hpp"
#include "lua/safe_mode.hpp"
#include "prompt/completion.hpp"
#include "prompt/output.hpp"
#include "prompt/user_files.hpp"
#include "terminal/display.hpp"
#include "text/not_copied.hpp"
#include "text/words.hpp"

// After <cstdio>: readline.h needs FILE.
#include <readline/history.h>
#include <readline/readline.h>
#endif

namespace dinal::prompt {

#ifdef DINAL_READLINE

namespace {

// The inputs of this and earlier sessions: in a file, in readline's list, and as suggestions for the present line.

constexpr int longest_history = 5000;  // entries

std::string_view entry_at(int i) {
    const HIST_ENTRY* entry = history_get(history_base + i);
    return entry == nullptr ? std::string_view() : entry->line;
}

/// Appends the text; returns errno or 0. A partial write is undone.
int append(const std::string& file, const std::string& text) {
    const files::Descriptor output(::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
    struct stat before {};
    if (output.number() < 0 || ::fstat(output.number(), &before) != 0) {
        return errno;
    }
    const ssize_t written = ::write(output.number(), text.data(), text.size());
    if (written == static_cast<ssize_t>(text.size())) {
        return 0;
    }
    const int why = written < 0 ? errno : ENOSPC;
    if (S_ISREG(before.st_mode) && ::ftruncate(output.number(), before.st_size) != 0) {
        return errno;
    }
    return why;
}

/// Loads the inputs of earlier sessions; `file` may be empty.
void open_history(const std::string& file) {
    // Time stamps let an entry of several lines be read back as one.
    history_comment_char = '#';
    history_write_timestamps = 1;
    stifle_history(longest_history);
    if (!file.empty()) {
        history_truncate_file(file.c_str(), longest_history);
        read_history(file.c_str());
    }
}

/// Adds an entry, possibly of several lines, to the list and the file. Returns the first failure to write, with the
/// file unchanged.
std::string add_to_history(const std::string& entry, const std::string& file) {
    static bool complained = false;
    if (entry.find_first_not_of(" \t\n") == std::string::npos ||
        (history_length > 0 && entry_at(history_length - 1) == entry)) {
        return "";
    }
    add_history(entry.c_str());
    if (file.empty()) {
        return "";
    }
    // Immediately: the session may end by a signal or os.exit.
    const int why = append(file, "#" + std::to_string(std::time(nullptr)) + "\n" + entry + "\n");
    const bool first = why != 0 && !complained;
    complained = complained || why != 0;
    return first ? "this input is not in " + file + ": " + std::generic_category().message(why) : "";
}

/// The continuation of the last input that begins with this line; "" without one.
std::string suggested(std::string_view line) {
    constexpr std::size_t shortest = 2;
    if (line.size() < shortest || line.find_first_not_of(' ') == std::string_view::npos) {
        return "";
    }
    for (int i = history_length - 1; i >= 0; --i) {
        const std::string_view entry = entry_at(i);
        if (entry.size() > line.size() && entry.starts_with(line) && entry.find('\n') == std::string_view::npos) {
            return std::string(entry.substr(line.size()));
        }
    }
    return "";
}

/// While this object lives, the up arrow first visits these lines of an unfinished chunk.
class LinesAbove : text::NotCopied {
public:
    explicit LinesAbove(std::string_view lines);
    ~LinesAbove();

private:
    int count_ = 0;
};

LinesAbove::LinesAbove(std::string_view lines) {
    for (const std::string_view line : text::split(lines, '\n')) {
        if (line.empty()) continue;
        add_history(std::string(line).c_str());
        ++count_;
    }
    using_history();
}

LinesAbove::~LinesAbove() {
    for (; count_ > 0 && history_length > 0; --count_) {
        HIST_ENTRY* const entry = remove_history(history_length - 1);
        std::free(free_history_entry(entry));  // NOLINT: allocated by readline; only the entry's data remain
    }
    using_history();
}

constexpr const char* erase_to_end = "\x1b[K";

// The state of readline's callbacks: there is one editor, and they receive no argument.
struct Editing {
    lua_State* L = nullptr;
    bool paints = false;   // whether hints are drawn
    bool hinting = false;  // whether a hint is behind the line
    bool accepted = false;
    TypedLine line;
    std::string prompt;
    std::string pending;  // previous lines of the chunk, each with its newline
    std::string cue;      // its missing part
    std::string rest;     // suggestion from history, in grey
    std::vector<std::string> names;
};
Editing editing;

void accept(char* text) {
    editing.accepted = true;
    editing.line = text == nullptr ? TypedLine{} : TypedLine{Reading::line, text};
    std::free(text);               // NOLINT: allocated by readline
    rl_callback_handler_remove();  // now, before readline prints another prompt
}

void erase_hint() {
    if (editing.hinting) {
        static_cast<void>(std::fputs(erase_to_end, rl_outstream));
        editing.hinting = false;
    }
}

int finish_line(int count, int key) {
    erase_hint();
    return rl_newline(count, key);
}

/// Accepts the suggestion on a right arrow at the end of the line.
bool accept_suggestion() {
    if (rl_point != rl_end || editing.rest.empty() || !editing.hinting) {
        return false;
    }
    rl_insert_text(editing.rest.c_str());
    return true;
}
int go_right(int count, int key) {
    return accept_suggestion() ? 0 : rl_forward_char(count, key);
}
int go_to_end(int count, int key) {
    return accept_suggestion() ? 0 : rl_end_of_line(count, key);
}

/// Moves the cursor to the same column of the line above or below within an input of several lines.
bool move_within_block(int by) {
    const std::string_view text(rl_line_buffer, static_cast<std::size_t>(rl_end));
    const auto point = static_cast<std::size_t>(rl_point);
    const auto begin_of = [text](std::size_t at) { return at == 0 ? 0 : text.rfind('\n', at - 1) + 1; };
    const std::size_t begin = begin_of(point);
    std::size_t target = 0;
    if (by < 0) {
        if (begin == 0) return false;
        target = begin_of(begin - 1);
    } else {
        const std::size_t end = text.find('\n', point);
        if (end == std::string_view::npos) return false;
        target = end + 1;
    }
    const std::size_t end = std::min(text.find('\n', target), text.size());
    rl_point = static_cast<int>(std::min(target + (point - begin), end));
    return true;
}
int go_up(int count, int key) {
    return move_within_block(-1) ? 0 : rl_get_previous_history(count, key);
}
int go_down(int count, int key) {
    return move_within_block(1) ? 0 : rl_get_next_history(count, key);
}
void bind_to_blocks() {
    for (const char* keys : {"\x1b[A", "\x1bOA"}) {
        if (rl_function_of_keyseq(keys, nullptr, nullptr) == rl_get_previous_history) rl_bind_keyseq(keys, go_up);
    }
    for (const char* keys : {"\x1b[B", "\x1bOB"}) {
        if (rl_function_of_keyseq(keys, nullptr, nullptr) == rl_get_next_history) rl_bind_keyseq(keys, go_down);
    }
}

/// Binds keys that the user has not bound otherwise.
void bind_to_suggestions() {
    for (const char* keys : {"\x1b[C", "\x1bOC", "\x06"}) {
        if (rl_function_of_keyseq(keys, nullptr, nullptr) == rl_forward_char) rl_bind_keyseq(keys, go_right);
    }
    for (const char* keys : {"\x1b[F", "\x1bOF", "\x05"}) {
        if (rl_function_of_keyseq(keys, nullptr, nullptr) == rl_end_of_line) rl_bind_keyseq(keys, go_to_end);
    }
}

/// Draws the line, and a hint behind it if it is one simple row.
void redisplay() {
    if (InterruptNote::interrupted()) {
        return;  // an abandoned line stays as it is
    }
    erase_hint();  // before the cursor moves, as it is at the beginning of the hint
    rl_redisplay();
    constexpr unsigned long other_uses = RL_STATE_ISEARCH | RL_STATE_NSEARCH | RL_STATE_SEARCH | RL_STATE_NUMERICARG |
                                         RL_STATE_COMPLETING | RL_STATE_VIMOTION;
    if (!editing.paints || RL_ISSTATE(other_uses) || rl_display_prompt != rl_prompt) {
        return;
    }
    const std::string_view line(rl_line_buffer, static_cast<std::size_t>(rl_end));
    editing.rest = rl_point == rl_end && editing.pending.empty() ? suggested(line) : "";
    const Painted painted = paint(editing.L, {.prompt = editing.prompt,
                                              .pending = editing.pending,
                                              .line = line,
                                              .cursor = static_cast<std::size_t>(rl_point),
                                              .cue = editing.cue,
                                              .rest = editing.rest});
    editing.hinting = painted.hint;
    if (!painted.text.empty()) {
        static_cast<void>(std::fputs(painted.text.c_str(), rl_outstream));
        static_cast<void>(std::fflush(rl_outstream));
    }
}

/// Readline's interface: returns one name after the other, each of which readline frees.
char* next_name(const char*, int again) {
    static std::size_t next = 0;
    next = again == 0 ? 0 : next;
    return next < editing.names.size() ? strdup(editing.names[next++].c_str()) : nullptr;
}

bool leads_outside(std::string_view path) {
    return path.starts_with('/') || path.starts_with('~') || path.find("..") != std::string_view::npos;
}

char** complete_word(const char* word, int, int end) {
    erase_hint();
    rl_attempted_completion_over = 1;  // no file names unless they fit
    rl_completion_append_character = '\0';
    const std::string line(rl_line_buffer, static_cast<std::size_t>(end));
    if (!editing.pending.empty() && line.find_first_not_of(' ') == std::string::npos) {
        rl_insert_text("  ");  // the key indents a line of a block
        return nullptr;
    }
    Completion completion = complete_safely(editing.L, editing.pending + line);
    if (completion.files && lua::safe_mode() && leads_outside(word)) {
        return nullptr;
    }
    if (completion.files) {
        return rl_completion_matches(word, rl_filename_completion_function);
    }
    editing.names = std::move(completion.names);
    return rl_completion_matches(word, next_name);
}

volatile std::sig_atomic_t resized = 0;
volatile std::sig_atomic_t continued = 0;

extern "C" void on_continue(int) {
    continued = 1;
}

extern "C" void on_resize(int) {
    resized = 1;
}

/// readline divides by a third of the width when it scrolls sideways.
constexpr int least_columns = 3;

/// NOTE: readline does not redraw its old line if other code draws, so nothing else is drawn meanwhile.
void fit_to_window() {
    if (terminal::display_of(STDOUT_FILENO).columns < least_columns) return;
    erase_hint();
    rl_redisplay_function = rl_redisplay;
    rl_resize_terminal();
    if (editing.paints) {
        rl_redisplay_function = redisplay;
        redisplay();
    }
}

/// Redraws after Ctrl-Z and fg, as the shell has written below the line.
void draw_again() {
    rl_on_new_line();
    rl_forced_update_display();
}

void notice(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = SA_RESTART;  // scripts must not notice the signal
    sigaction(signal, &action, nullptr);
}

/// Waits for a key or a signal, which readline handles. Returns true if there is a key to read.
bool key_arrived() {
    bool arrived = false;
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    // All signals are blocked between the last check and ppoll, so that none is missed.
    sigprocmask(SIG_BLOCK, &all, &before);
    if (rl_pending_signal() == 0 && !InterruptNote::interrupted() && resized == 0 && continued == 0) {
        pollfd input{fileno(rl_instream), POLLIN, 0};
        arrived = ppoll(&input, 1, nullptr, &before) > 0;
    }
    sigprocmask(SIG_SETMASK, &before, nullptr);
    rl_check_signals();  // restores the terminal and raises the signal for InterruptNote
    if (resized != 0) {
        resized = 0;
        fit_to_window();
    }
    if (continued != 0) {
        continued = 0;
        draw_again();
    }
    return arrived && !InterruptNote::interrupted();
}

/// Reads a key for readline. NOTE: Ctrl-C discards earlier keys, so an announced key may be gone; a blocking read would
/// then delay the Ctrl-C.
int read_key(FILE*) {
    static const int keyboard = open("/proc/self/fd/0", O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    while (!InterruptNote::interrupted()) {
        if (!key_arrived()) {
            continue;
        }
        unsigned char key = 0;
        const ssize_t count = read(keyboard < 0 ? STDIN_FILENO : keyboard, &key, 1);
        if (count == 1) {
            return key;
        }
        if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
            break;  // the terminal is gone
        }
    }
    return EOF;
}

void start_readline(const std::string& history) {
    rl_readline_name = "dinal";
    rl_catch_signals = 1;               // restores the terminal before Ctrl-Z etc. take effect,
    rl_persistent_signal_handlers = 1;  // also while waiting for a key
    rl_getc_function = read_key;
    rl_attempted_completion_function = complete_word;
    rl_completer_word_break_characters = const_cast<char*>(" \t\n\"\\'`@$><=;|&{}()[]:.,+-*/%^~#!?");  // only read
    rl_completer_quote_characters = "\"'";
    rl_catch_sigwinch = 0;
    notice(SIGWINCH, on_resize);
    notice(SIGCONT, on_continue);
    rl_initialize();
    int rows = 0, columns = 0;
    rl_get_screen_size(&rows, &columns);
    if (columns < least_columns) rl_set_screen_size(rows, least_columns + 1);
    // After the user's inputrc. A blinking parenthesis would swallow a Ctrl-C within half a second.
    rl_variable_bind("blink-matching-paren", "off");
    rl_variable_bind("enable-bracketed-paste", terminal::obeys_escapes() ? "on" : "off");
    open_history(history);
    bind_to_blocks();
    editing.paints = terminal::display_of(STDOUT_FILENO).colour;
    if (editing.paints) {
        rl_redisplay_function = redisplay;
        rl_bind_key('\r', finish_line);
        rl_bind_key('\n', finish_line);
        bind_to_suggestions();
    }
}

void give_up() {
    if (!editing.accepted) {
        erase_hint();
        rl_callback_sigcleanup();
        rl_free_line_state();
        rl_callback_handler_remove();
    }
    say("\n");  // rl_outstream is standard output
}

TypedLine read_edited(const std::string& prompt, const std::string& pending, const std::string& cue) {
    const InterruptNote note;
    const LinesAbove above(pending);
    editing.accepted = false;
    editing.hinting = false;
    editing.prompt = prompt;
    editing.pending = pending.empty() ? "" : pending + "\n";
    editing.cue = cue;
    rl_eof_found = 0;  // a flag from an earlier line would end every further line
    rl_callback_handler_install(prompt.c_str(), accept);
    if (const char key = terminal::key_left_over(); key != '\0') {
        rl_stuff_char(static_cast<unsigned char>(key));
        rl_callback_read_char();
    }
    while (!editing.accepted) {
        if (key_arrived()) {
            rl_callback_read_char();
        }
        if (InterruptNote::interrupted()) {  // also if the line was just accepted, because it has not run yet
            give_up();
            return {Reading::interrupted, ""};
        }
    }
    return editing.line;
}

}  // namespace

// NOTE: never use readline on a pipe: it spins at the end and completes at tabs.
LineEditor::LineEditor(lua_State* L) : edits_(isatty(STDIN_FILENO) != 0 && isatty(STDOUT_FILENO) != 0) {
    if (edits_) {
        editing.L = L;
        history_file_ = state_file("history");
        start_readline(history_file_);
    }
}

TypedLine LineEditor::read(const std::string& prompt, const std::string& pending, const std::string& cue) const {
    return edits_ ? read_edited(prompt, pending, cue) : read_plain(prompt);
}

void LineEditor::remember(const std::string& entry) {
    if (const std::string problem = edits_ ? add_to_history(entry, history_file_) : ""; !problem.empty()) {
        say_error("(" + problem + ")");
    }
}

const char* LineEditor::about() {
    return "Lines are edited with GNU Readline: this program may be distributed under the GNU GPL, version 3 or later.";
}

#else

LineEditor::LineEditor(lua_State*) : edits_(false) {}

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): otherwise it is not static
TypedLine LineEditor::read(const std::string& prompt, const std::string&, const std::string&) const {
    return read_plain(prompt);
}

void LineEditor::remember(const std::string&) {}

const char* LineEditor::about() {
    return "Built without GNU Readline: this program is under the MIT licence as well.";
}

#endif

}  // namespace dinal::prompt
