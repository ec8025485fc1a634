#include "lua/time_limit.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>
#include <ctime>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <string>
#include <system_error>

#include "lua/interrupt.hpp"
#include "lua/limits.hpp"

namespace dinal::lua {
namespace {

using Nanoseconds = std::int64_t;
constexpr Nanoseconds one_second = 1'000'000'000;
constexpr Nanoseconds patience = one_second;  // an integration, a sort or a collection of garbage may be on its way

double allowed_time = 0;  // seconds; 0: none
timer_t timer{};
pthread_t lua_thread{};
int nesting = 0;
std::atomic<Nanoseconds> deadline = 0;  // by CLOCK_MONOTONIC; 0: the time does not run
static_assert(std::atomic<Nanoseconds>::is_always_lock_free, "a signal handler may use lock-free atomics only");

bool is_overdue_by(Nanoseconds time) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);  // allowed in a signal handler
    const Nanoseconds end = deadline;
    return end != 0 && now.tv_sec * one_second + now.tv_nsec >= end + time;
}

/// On the thread of Lua. It asks again: the chunk that was meant may have ended meanwhile.
extern "C" void on_alarm(int) {
    if (is_overdue_by(0)) {
        request_stop(Stop::time);
    }
}

bool takes_text(int descriptor) {
    pollfd output{descriptor, POLLOUT, 0};
    return poll(&output, 1, 0) == 1 && (output.revents & POLLOUT) != 0;
}

[[noreturn]] void end_program() {
    // What the script has printed shall be seen. Not when it is just printing, or when nobody reads.
    if (takes_text(STDOUT_FILENO) && ftrylockfile(stdout) == 0) {
        static_cast<void>(std::fflush(stdout));
    }
    const std::string text = "dinal: " + limit_sentence(Stop::time, "") + "\n";
    if (takes_text(STDERR_FILENO)) {
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    }
    _exit(1);
}

/// On a thread that the timer starts, at the deadline and each second after it: what it does is not bound to what is
/// allowed in a signal handler.
void on_expiry(sigval) {
    if (is_overdue_by(patience)) {
        end_program();
    }
    if (is_overdue_by(0)) {
        pthread_kill(lua_thread, SIGALRM);
    }
}

void set_timer(Nanoseconds start) {
    deadline = start;
    itimerspec times{};
    times.it_value = {start / one_second, start % one_second};  // 0 stops it
    times.it_interval = {patience / one_second, patience % one_second};
    timer_settime(timer, TIMER_ABSTIME, &times, nullptr);
}

}  // namespace

void set_time_limit(double seconds) {
    set_handler(SIGALRM, on_alarm);
    sigevent event{};
    event.sigev_notify = SIGEV_THREAD;
    event.sigev_notify_function = on_expiry;
    if (timer_create(CLOCK_MONOTONIC, &event, &timer) != 0) {
        throw std::system_error(errno, std::generic_category(), "the time of scripts cannot be limited");
    }
    lua_thread = pthread_self();
    allowed_time = seconds;
}

double time_limit() noexcept {
    return allowed_time;
}

TimeAllowance::TimeAllowance() {
    if (allowed_time > 0 && nesting++ == 0) {
        timespec now{};
        clock_gettime(CLOCK_MONOTONIC, &now);
        set_timer(now.tv_sec * one_second + now.tv_nsec + static_cast<Nanoseconds>(allowed_time * 1e9));
    }
}

TimeAllowance::~TimeAllowance() {
    if (allowed_time > 0 && --nesting == 0) {
        set_timer(0);
    }
}

}  // namespace dinal::lua
