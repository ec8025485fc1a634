#include "lua/last_words.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

namespace dinal::lua {

namespace {

bool takes_more(int descriptor, int wait_ms) {
    pollfd output{descriptor, POLLOUT, 0};
    return poll(&output, 1, wait_ms) == 1 && (output.revents & POLLOUT) != 0;
}

}  // namespace

void write_error_in_time(std::string_view text) {
    // What a pipe takes at once, PIPE_BUF bytes, does not block.
    constexpr std::size_t most = 4096;
    constexpr int patient_ms = 500;
    while (!text.empty() && takes_more(STDERR_FILENO, patient_ms)) {
        const ssize_t written = ::write(STDERR_FILENO, text.data(), std::min(text.size(), most));
        if (written <= 0) {
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void exit_in_time(int code) {
    if (takes_more(STDOUT_FILENO, 0)) {
        std::exit(code);
    }
    _exit(code);
}

}  // namespace dinal::lua
