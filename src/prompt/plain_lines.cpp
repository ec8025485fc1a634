// Lines read without an editor, and the handling of Ctrl-C meanwhile.
#include "prompt/line_editor.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "prompt/output.hpp"
#include "text/words.hpp"

namespace dinal::prompt {
namespace {

volatile std::sig_atomic_t interrupt_seen = 0;

extern "C" void note_interrupt(int) {
    interrupt_seen = 1;
}

/// The length of a prompt "In [12]: " at the beginning of the line, otherwise 0.
std::size_t numbered_prompt(std::string_view line) {
    constexpr std::string_view head = "In [", tail = "]: ";
    if (!line.starts_with(head)) {
        return 0;
    }
    std::size_t end = head.size();
    while (end < line.size() && text::is_digit(line[end])) {
        ++end;
    }
    return end > head.size() && line.substr(end).starts_with(tail) ? end + tail.size() : 0;
}

}  // namespace

std::optional<std::string_view> behind_prompt(std::string_view line) {
    constexpr std::array<std::string_view, 5> prompts = {"> ", ">> ", ">>> ", "dinal> ", "...: "};
    const std::string_view text = line.substr(std::min(line.find_first_not_of(" \t"), line.size()));
    for (const std::string_view prompt : prompts) {
        if (text.starts_with(prompt)) {
            return text.substr(prompt.size());
        }
        if (text == prompt.substr(0, prompt.size() - 1) && prompt.front() == '>') {
            return std::string_view();
        }
    }
    const std::size_t numbered = numbered_prompt(text);
    return numbered > 0 ? std::optional(text.substr(numbered)) : std::nullopt;
}

InterruptNote::InterruptNote() {
    interrupt_seen = 0;
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    sigemptyset(&action.sa_mask);
    action.sa_flags = 0;  // no SA_RESTART: reading must wake up
    sigaction(SIGINT, &action, &before_);
}

InterruptNote::~InterruptNote() {
    sigaction(SIGINT, &before_, nullptr);
}

bool InterruptNote::interrupted() {
    return interrupt_seen != 0;
}

TypedLine read_plain(const std::string& prompt) {
    const InterruptNote note;
    // Ctrl-C is blocked until pselect: between prompt and reading it would be lost.
    sigset_t held, before;
    sigemptyset(&held);
    sigaddset(&held, SIGINT);
    pthread_sigmask(SIG_BLOCK, &held, &before);
    say(prompt);
    flush_output();
    if (isatty(STDIN_FILENO) == 1) {
        pollfd keyboard{.fd = STDIN_FILENO, .events = POLLIN, .revents = 0};
        ppoll(&keyboard, 1, nullptr, &before);
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    if (InterruptNote::interrupted()) {
        say("\n");
        return {Reading::interrupted, ""};
    }
    char* buffer = nullptr;
    std::size_t capacity = 0;
    // The same FILE as io.read, so that Lua code can read the following lines.
    const ssize_t size = getline(&buffer, &capacity, stdin);
    std::string text(buffer == nullptr ? "" : buffer, size > 0 ? static_cast<std::size_t>(size) : 0);
    std::free(buffer);  // NOLINT: allocated by getline
    if (InterruptNote::interrupted()) {
        std::clearerr(stdin);
        say("\n");
        return {Reading::interrupted, ""};
    }
    if (size < 0) {
        std::clearerr(stdin);  // Ctrl-D ends this line, not the input
        return {Reading::end, ""};
    }
    if (text.back() == '\n') {
        text.pop_back();
    }
    return {Reading::line, text};
}

}  // namespace dinal::prompt
