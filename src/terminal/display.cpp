#include "terminal/display.hpp"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "text/characters.hpp"

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

}  // namespace dinal::terminal
