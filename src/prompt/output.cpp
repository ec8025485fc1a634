#include "prompt/output.hpp"

#include <unistd.h>

#include <cstdio>
#include <string>

#include "lua/limits.hpp"
#include "terminal/display.hpp"
#include "text/characters.hpp"
#include "text/harmless.hpp"

namespace dinal::prompt {
namespace {

std::string* collected_errors = nullptr;

}  // namespace

ErrorsInto::ErrorsInto(std::string& text) {
    collected_errors = &text;
}
ErrorsInto::~ErrorsInto() {
    collected_errors = nullptr;
}

void say(std::string_view text) {
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
}

void say_value(std::string_view text) {
    say(terminal::display_of(STDOUT_FILENO).terminal ? text::harmless(text) : std::string(text));
}

void flush_output() {
    static_cast<void>(std::fflush(stdout));
}

void say_error(std::string_view text) {
    if (collected_errors != nullptr) {
        collected_errors->append(text).append("\n");
        return;
    }
    flush_output();
    const terminal::Display screen = terminal::display_of(STDERR_FILENO);
    const std::string fitting = screen.terminal ? text::wrapped(text::harmless(text), screen.width - 1) : "";
    text = screen.terminal ? fitting : text;
    if (!lua::reached_limit().empty()) {
        lua::write_error_in_time(std::string(text) + "\n");
        return;
    }
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
    static_cast<void>(std::fputc('\n', stderr));
}

}  // namespace dinal::prompt
