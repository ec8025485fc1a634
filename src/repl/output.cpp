#include "repl/output.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "io/display.hpp"

namespace dinal {
namespace {

/// Long sentences in rows of whole words. Lines that begin with a blank are laid out already.
std::string in_rows(std::string_view text, std::size_t width) {
    std::string result;
    for (;;) {
        const std::string_view line = text.substr(0, text.find('\n'));
        const bool sentence = !line.empty() && line.front() != ' ' && columns(line) >= width;
        result += sentence ? wrapped(line, width - 1) : std::string(line);
        if (line.size() == text.size()) {
            return result;
        }
        result += '\n';
        text.remove_prefix(line.size() + 1);
    }
}

}  // namespace

void say(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

void flush_output() {
    static_cast<void>(std::fflush(stdout));
}

void say_error(std::string_view text) {
    flush_output();
    const Display screen = display_of(STDERR_FILENO);
    const std::string fitting = screen.terminal ? in_rows(text, screen.width) : "";
    text = screen.terminal ? fitting : text;
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fputc('\n', stderr));
}

}  // namespace dinal
