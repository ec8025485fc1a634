#include "lua/time_limit.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>
#include <csignal>
#include <cstdio>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "lua/interrupt.hpp"
#include "lua/limits.hpp"

namespace dinal::lua {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds patience{1};  // an integration, a sort or a collection of garbage may be on its way

struct Watch {
    double seconds = 0;
    pthread_t lua_thread = pthread_self();
    std::mutex mutex;
    std::condition_variable changed;
    std::optional<Clock::time_point> deadline = {};
    int nesting = 0;
};

Watch* watch = nullptr;  // never deleted: its thread lives as long as the process

extern "C" void on_alarm(int) {
    request_stop(Stop::time);
}

/// What the script has printed shall be seen. Not when it is just printing, or when nobody reads.
void flush_if_possible() {
    pollfd output{STDOUT_FILENO, POLLOUT, 0};
    if (poll(&output, 1, 0) == 1 && ftrylockfile(stdout) == 0) {
        static_cast<void>(std::fflush(stdout));
    }
}

[[noreturn]] void end_program() {
    flush_if_possible();
    const std::string text = "dinal: " + limit_sentence(Stop::time, "") + "\n";
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
    _exit(1);
}

/// True when `until` has come and the deadline is still the same.
bool reached(std::unique_lock<std::mutex>& lock, Clock::time_point deadline, Clock::time_point until) {
    return !watch->changed.wait_until(lock, until, [=] { return watch->deadline != deadline; });
}

[[noreturn]] void keep_watch() {
    std::unique_lock lock(watch->mutex);
    for (;;) {
        watch->changed.wait(lock, [] { return watch->deadline.has_value(); });
        const Clock::time_point deadline = *watch->deadline;
        if (reached(lock, deadline, deadline)) {
            pthread_kill(watch->lua_thread, SIGALRM);
            if (reached(lock, deadline, deadline + patience)) {
                end_program();
            }
        }
    }
}

/// All signals go to the thread of Lua.
void start_watching() {
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread(keep_watch).detach();
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace

void set_time_limit(double seconds) {
    struct sigaction action {};
    action.sa_handler = on_alarm;
    sigemptyset(&action.sa_mask);
    action.sa_flags = 0;  // no SA_RESTART: a script that waits in io.read() must wake up
    sigaction(SIGALRM, &action, nullptr);
    watch = new Watch;  // NOLINT(cppcoreguidelines-owning-memory): see above
    watch->seconds = seconds;
    start_watching();
}

double time_limit() noexcept {
    return watch == nullptr ? 0 : watch->seconds;
}

TimeAllowance::TimeAllowance() {
    if (watch != nullptr && watch->nesting++ == 0) {
        const std::lock_guard lock(watch->mutex);
        const std::chrono::duration<double> time(watch->seconds);
        watch->deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
        watch->changed.notify_one();
    }
}

TimeAllowance::~TimeAllowance() {
    if (watch != nullptr && --watch->nesting == 0) {
        const std::lock_guard lock(watch->mutex);
        watch->deadline.reset();
        watch->changed.notify_one();
    }
}

}  // namespace dinal::lua
