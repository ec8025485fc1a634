#include "lua/limits.hpp"

#include <fmt/format.h>

#include <poll.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "lua/interrupt.hpp"
#include "lua/memory_limit.hpp"

namespace dinal::lua {
namespace {

/// "256M", as in the command line.
std::string size_text(std::size_t bytes) {
    constexpr std::array<std::pair<std::size_t, char>, 3> units{{{30, 'G'}, {20, 'M'}, {10, 'K'}}};
    for (const auto& [shift, letter] : units) {
        if (const std::size_t unit = std::size_t{1} << shift; bytes >= unit && bytes % unit == 0) {
            return fmt::format("{}{}", bytes / unit, letter);
        }
    }
    return fmt::format("{} bytes", bytes);
}

}  // namespace

void set_limits(lua_State* L, const ScriptLimits& limits) {
    if (limits.memory > 0) {
        set_memory_limit(L, limits.memory);
    }
    if (limits.seconds > 0) {
        set_time_limit(limits.seconds);
    }
}

std::string limit_sentence(Stop reason, const std::string& place) {
    const std::string what = reason == Stop::time
                                 ? fmt::format("ran longer than the {:.6g} s that --max-time allows", time_limit())
                                 : "needed more than the " + size_text(memory_limit()) + " that --max-memory allows";
    return fmt::format("stopped{}{}: it {}", place.empty() ? "" : " at ", place, what);
}

std::string reached_limit() {
    const Stop reason = stop_requested();
    return reason == Stop::time || reason == Stop::memory ? limit_sentence(reason, stopped_at()) : "";
}

namespace {

bool takes_more(int descriptor, int wait_ms) {
    pollfd output{descriptor, POLLOUT, 0};
    return poll(&output, 1, wait_ms) == 1 && (output.revents & POLLOUT) != 0;
}

}  // namespace

void write_error_in_time(std::string_view text) {
    // A pipe accepts up to PIPE_BUF bytes without blocking.
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
