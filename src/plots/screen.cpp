#include "plots/screen.hpp"

#include <langinfo.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace dinal::plots {
namespace {

std::string_view variable(const char* name) {
    const char* text = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): nobody sets variables
    return text == nullptr ? "" : text;
}

}  // namespace

Screen screen() {
    Screen found;
    found.terminal = isatty(STDOUT_FILENO) != 0;
    winsize size{};
    if (found.terminal && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
        found.columns = size.ws_col;
        found.rows = size.ws_row;
    }
    const bool dumb = found.terminal && variable("TERM") == "dumb";
    if (std::string_view(nl_langinfo(CODESET)) == "UTF-8" && !dumb) {
        found.charset = Charset::braille;
    }
    found.colours = found.terminal && !dumb && variable("NO_COLOR").empty();
    return found;
}

}  // namespace dinal::plots
