#include "terminal/display.hpp"

#include <fmt/format.h>
#include <langinfo.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "text/characters.hpp"
#include "text/not_copied.hpp"

namespace dinal::terminal {

namespace {

constexpr int narrowest = 20;  // text laid out for fewer columns is unreadable anyway

std::string_view variable(const char* name) {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets variables
    return value == nullptr ? "" : value;
}

}  // namespace

bool obeys_escapes() {
    const std::string_view name = variable("TERM");
    return !name.empty() && name != "dumb";
}

Display display_of(int descriptor) {
    Display screen;
    screen.terminal = isatty(descriptor) != 0;
    screen.unicode = std::string_view(nl_langinfo(CODESET)) == "UTF-8";  // NOLINT(concurrency-mt-unsafe)
    screen.draws = screen.unicode && !(screen.terminal && variable("TERM") == "dumb");
    if (!screen.terminal) {
        return screen;
    }
    screen.colour = obeys_escapes() && variable("NO_COLOR").empty();  // see https://no-color.org
    winsize size{};
    if (ioctl(descriptor, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
        screen.columns = size.ws_col;
        screen.rows = size.ws_row;
        screen.width = static_cast<std::size_t>(std::max(screen.columns, narrowest));
    }
    return screen;
}

std::string spelled(std::string_view text, const Display& screen) {
    return screen.unicode ? std::string(text) : text::in_ascii(text);
}

namespace {

void write_out(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

/// Reads single keys without echo during its lifetime; Ctrl-C is read as a key, too.
class Keys : text::NotCopied {
public:
    Keys() : good_(::tcgetattr(STDIN_FILENO, &before_) == 0) {
        termios now = before_;
        now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO | ISIG);
        now.c_cc[VMIN] = 1;
        now.c_cc[VTIME] = 0;
        good_ = good_ && ::tcsetattr(STDIN_FILENO, TCSADRAIN, &now) == 0;
    }
    ~Keys() {
        if (good_) ::tcsetattr(STDIN_FILENO, TCSADRAIN, &before_);
    }

    /// Returns '\0' at the end of the input or after a signal.
    char read() const {
        char key = '\0';
        return good_ && ::read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
    }

private:
    termios before_{};
    bool good_;
};

bool keys_wait() {
    pollfd keys{STDIN_FILENO, POLLIN, 0};
    return ::poll(&keys, 1, 0) > 0;
}

bool has_pages(const Display& screen) {
    const char* pager = std::getenv("PAGER");  // NOLINT(concurrency-mt-unsafe): nobody sets variables
    const bool wanted = pager == nullptr || (*pager != '\0' && std::string_view(pager) != "cat");
    // Keys that have been typed already are meant for the prompt.
    return wanted && screen.terminal && obeys_escapes() && ::isatty(STDIN_FILENO) != 0 && !keys_wait();
}

/// Returns the rows of the screen, each a part of the text with its end of line.
std::vector<std::string_view> rows_of(std::string_view text, std::size_t width) {
    std::vector<std::string_view> rows;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
        const std::string_view fits = text::cut_to_columns(text.substr(0, end), width);
        const std::size_t size = fits.size() + 1 >= end || fits.empty() ? end : fits.size();
        rows.push_back(text.substr(0, size));
        text.remove_prefix(size);
    }
    return rows;
}

char left_over = '\0';

enum class Wanted { row, page, nothing };

Wanted ask(std::size_t shown, std::size_t all, std::size_t width) {
    const std::string line = fmt::format("-- {} of {} lines: Space goes on, q ends --", shown, all);
    write_out(fmt::format("\x1b[7m{}\x1b[0m", text::cut_to_columns(line, width - 1)));
    static_cast<void>(std::fflush(stdout));
    const char key = Keys().read();
    write_out("\r\x1b[K");
    if (key == '\r' || key == '\n' || key == 'j') return Wanted::row;
    if (key == ' ' || key == 'f') return Wanted::page;
    const bool ends_only = key == 'q' || key == 'Q' || static_cast<unsigned char>(key) < ' ';
    left_over = ends_only ? '\0' : key;
    return Wanted::nothing;
}

/// Breaks the remaining rows again after a change of the terminal's width.
void cut_anew(std::vector<std::string_view>& rows, std::size_t shown, std::string_view text, std::size_t width) {
    const auto at = static_cast<std::size_t>(rows[shown].data() - text.data());
    rows.resize(shown);
    const std::vector<std::string_view> rest = rows_of(text.substr(at), width);
    rows.insert(rows.end(), rest.begin(), rest.end());
}

}  // namespace

char key_left_over() {
    return std::exchange(left_over, '\0');
}

void show_in_pages(std::string_view text) {
    static_cast<void>(std::fflush(stdout));
    Display screen = display_of(STDOUT_FILENO);
    constexpr int least_rows = 5;
    if (screen.rows < least_rows || !has_pages(screen)) {
        write_out(text);
        return;
    }
    std::vector<std::string_view> rows = rows_of(text, screen.width);
    std::size_t shown = 0, page = static_cast<std::size_t>(screen.rows) - 1;
    for (std::size_t wanted = rows.size() <= page ? rows.size() : page; wanted > 0;) {
        for (; wanted > 0 && shown < rows.size(); --wanted, ++shown) write_out(rows[shown]);
        if (shown == rows.size()) break;
        const Wanted more = ask(shown, rows.size(), screen.width);
        const Display now = display_of(STDOUT_FILENO);  // the window may have been resized meanwhile
        if (now.width != screen.width) cut_anew(rows, shown, text, now.width);
        screen = now;
        page = static_cast<std::size_t>(std::max(screen.rows, least_rows)) - 1;
        wanted = more == Wanted::page ? page - 1 : more == Wanted::row ? 1 : 0;
    }
    static_cast<void>(std::fflush(stdout));
}

}  // namespace dinal::terminal
