#include "prompt/output.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "terminal/display.hpp"
#include "text/characters.hpp"

namespace dinal::prompt {
void say(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

void flush_output() {
    static_cast<void>(std::fflush(stdout));
}

void say_error(std::string_view text) {
    flush_output();
    const terminal::Display screen = terminal::display_of(STDERR_FILENO);
    const std::string fitting = screen.terminal ? text::wrapped(text, screen.width - 1) : "";
    text = screen.terminal ? fitting : text;
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fputc('\n', stderr));
}

}  // namespace dinal::prompt
