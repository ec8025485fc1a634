#include "lua/interrupt.hpp"

#include <poll.h>
#include <pthread.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <system_error>

#include "files/file.hpp"
#include "lua/memory_limit.hpp"
#include "lua/safe_mode.hpp"
#include "terminal/progress.hpp"

namespace dinal::lua {

namespace {

static_assert(std::atomic<lua_State*>::is_always_lock_free && std::atomic<Stop>::is_always_lock_free &&
                  std::atomic<bool>::is_always_lock_free && std::atomic<long>::is_always_lock_free,
              "a signal handler may use lock-free atomics only");

std::atomic<Stop> requested = Stop::none;
std::atomic<bool> armed = false;
std::atomic<lua_State*> running = nullptr;                          // on the program's thread
thread_local std::atomic<lua_State*>* running_in_worker = nullptr;  // on the thread of a WorkerScope
thread_local const WorkerWatch* watch_of_worker = nullptr;          // on the thread of a WorkerScope
std::atomic<long> first_signal_ms = 0;                              // first Ctrl-C in this chunk; 0: none
std::array<char, LUA_IDSIZE + 20> stopping_place{};

// Stoppable code stops within this time. A key that is held down repeats faster.
constexpr long patience_ms = 200;

/// The Lua thread that runs on this OS thread. Called in signal handlers, so the variables above must be initialised.
std::atomic<lua_State*>& running_here() noexcept {
    return running_in_worker != nullptr ? *running_in_worker : running;
}

void note_place(lua_State* L) {
    lua_Debug frame{};
    for (int level = 0; lua_getstack(L, level, &frame) != 0; ++level) {
        lua_getinfo(L, "Sl", &frame);
        if (frame.currentline > 0) {
            static_cast<void>(std::snprintf(stopping_place.data(), stopping_place.size(), "%s:%d", frame.short_src,
                                            frame.currentline));
            return;
        }
    }
}

/// Main thread only: a worker's position is not reported.
void note_first_place(lua_State* L) {
    if (running_in_worker == nullptr && stopping_place[0] == '\0') {
        note_place(L);
    }
}

void interrupt_hook(lua_State* L, lua_Debug*) {
    stop_after_refusal();
    if (interrupt_requested() && armed) {
        raise_interrupted(L);
    }
    lua_sethook(L, nullptr, 0, 0);  // a leftover from a chunk that has ended
}

void set_hook(lua_State* L) {
    // The hook is called at each instruction until the chunk ends, so that a loop around pcall stops. It is not called
    // at calls and returns, because a message handler in C (traceback) must be able to work.
    lua_sethook(L, interrupt_hook, LUA_MASKCOUNT, 1);
}

long now_ms() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);  // allowed in a signal handler
    return static_cast<long>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000 + 1;
}

extern "C" void on_signal(int) {
    if (armed) {
        long first = 0;
        const long now = now_ms();
        if (!first_signal_ms.compare_exchange_strong(first, now) && now - first > patience_ms) {
            _exit(130);  // the only way out of C code that never returns
        }
    }
    request_stop(Stop::interrupted);
}

/// Runs on a worker's thread. The worker may have finished its task; the hook checks that.
extern "C" void on_nudge(int) {
    if (lua_State* L = running_here(); running_in_worker != nullptr && armed && L != nullptr) {
        set_hook(L);
    }
}

}  // namespace

void set_handler(int signal, void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    action.sa_flags = 0;  // no SA_RESTART: a script that waits in io.read() must wake up
    sigaction(signal, &action, nullptr);
}

void install_interrupt_handler() {
    set_handler(SIGINT, on_signal);
    install_stop_handlers();
}

void install_stop_handlers() {
    set_handler(SIGURG, on_nudge);
    files::set_stop_question(interrupt_requested);
}

Stop stop_requested() noexcept {
    return requested.load(std::memory_order_relaxed);
}

bool interrupt_requested() noexcept {
    return stop_requested() != Stop::none || (watch_of_worker != nullptr && watch_of_worker->must_stop());
}

const WorkerWatch* watch_here() noexcept {
    return watch_of_worker;
}

bool chunk_runs() noexcept {
    return armed.load(std::memory_order_relaxed);
}

void request_stop(Stop reason) noexcept {
    Stop none = Stop::none;
    requested.compare_exchange_strong(none, reason);
    if (lua_State* L = running_here(); armed && L != nullptr) {
        set_hook(L);
    }
}

void stop_here(Stop reason) noexcept {
    if (lua_State* L = running_here(); chunk_runs() && L != nullptr) {
        note_first_place(L);
    }
    request_stop(reason);
}

void look_at_next_instruction() noexcept {
    if (lua_State* L = running_here(); armed && L != nullptr) set_hook(L);
}

void raise_interrupted(lua_State* L) {
    note_first_place(L);
    if (stop_requested() == Stop::interrupted) {
        lua_pushliteral(L, "interrupted!");
    } else {
        lua_pushliteral(L, "limit reached!");
    }
    lua_error(L);
    std::terminate();  // lua_error does not return, but is not declared so
}

std::string stopped_at() {
    return stopping_place.data();
}

InterruptScope::InterruptScope(lua_State* L) : L_(L), within_(armed) {
    if (within_) {
        return;
    }
    requested = Stop::none;
    first_signal_ms = 0;
    stopping_place[0] = '\0';
    running = L;
    armed = true;
}

InterruptScope::~InterruptScope() {
    terminal::end_progress();
    if (within_) {
        return;
    }
    armed = false;
    running = nullptr;
    if (lua_gethook(L_) == interrupt_hook) {
        lua_sethook(L_, nullptr, 0, 0);
    }
}

WorkerScope::WorkerScope(lua_State* L, const WorkerWatch* watch)
    : running_(L), outer_(running_in_worker), outer_watch_(watch_of_worker) {
    running_in_worker = &running_;
    watch_of_worker = watch;
    terminal::show_no_progress_here();
}

WorkerScope::~WorkerScope() {
    watch_of_worker = outer_watch_;
    running_in_worker = outer_;
}

bool in_worker() noexcept {
    return running_in_worker != nullptr;
}

void nudge(pthread_t worker) noexcept {
    pthread_kill(worker, SIGURG);
}

NoSignalsForNewThreads::NoSignalsForNewThreads() {
    sigset_t others;
    sigfillset(&others);
    sigdelset(&others, SIGURG);
    pthread_sigmask(SIG_SETMASK, &others, &before_);
}

NoSignalsForNewThreads::~NoSignalsForNewThreads() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

RunningThread::RunningThread(lua_State* caller, lua_State* callee) : caller_(caller) {
    if (lua_gethook(callee) == interrupt_hook && requested == Stop::none) {
        lua_sethook(callee, nullptr, 0, 0);  // created or stopped while an earlier chunk was being interrupted
    }
    running_here() = callee;
    if (requested != Stop::none && armed) {
        set_hook(callee);
    }
}

RunningThread::~RunningThread() {
    stop_after_refusal();
    running_here() = caller_;
    if (requested != Stop::none && armed) {
        set_hook(caller_);  // the coroutine was stopped, so its caller also is
    }
}

namespace {

using Nanoseconds = std::int64_t;
constexpr Nanoseconds one_second = 1'000'000'000;
constexpr Nanoseconds patience = one_second;  // time for an integration, sort or garbage collection to finish

double allowed_time = 0;  // seconds; 0: no limit
timer_t timer{};
pthread_t lua_thread{};
int nesting = 0;
std::atomic<Nanoseconds> deadline = 0, latest = 0;  // by processor time and by wall time; 0: not running
static_assert(std::atomic<Nanoseconds>::is_always_lock_free, "a signal handler may use lock-free atomics only");

Nanoseconds now_by(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);  // allowed in a signal handler
    return now.tv_sec * one_second + now.tv_nsec;
}

bool is_overdue_by(Nanoseconds time) {
    const Nanoseconds end = deadline, last = latest;
    return end != 0 && (now_by(CLOCK_PROCESS_CPUTIME_ID) >= end + time || now_by(CLOCK_MONOTONIC) >= last + time);
}

/// Runs on Lua's thread. Checks the time again, as the chunk may have ended meanwhile.
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
    // Writes the script's output, unless stdout is locked or nobody reads it.
    if (takes_text(STDOUT_FILENO) && ftrylockfile(stdout) == 0) {
        static_cast<void>(std::fflush(stdout));
    }
    const std::string text = "dinal: " + limit_sentence(Stop::time, "") + "\n";
    if (takes_text(STDERR_FILENO)) {
        [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
    }
    _exit(1);
}

/// Runs on a thread of the timer, repeatedly after the deadline, and so may do more than a signal handler.
void on_expiry(sigval) {
    if (is_overdue_by(patience)) {
        end_program();
    }
    if (is_overdue_by(0)) {
        pthread_kill(lua_thread, SIGALRM);
    }
}

/// Starts the timer; 0 stops it.
void set_timer(Nanoseconds allowed) {
    if (allowed > 0) latest = now_by(CLOCK_MONOTONIC) + longest_wait * allowed;  // must be set before the deadline
    deadline = allowed > 0 ? now_by(CLOCK_PROCESS_CPUTIME_ID) + allowed : 0;
    itimerspec times{};
    times.it_value = {allowed / one_second, allowed % one_second};
    times.it_interval = {0, one_second / 20};
    timer_settime(timer, 0, &times, nullptr);
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
        set_timer(std::max<Nanoseconds>(1, static_cast<Nanoseconds>(allowed_time * 1e9)));
    }
}

TimeAllowance::~TimeAllowance() {
    if (allowed_time > 0 && --nesting == 0) {
        set_timer(0);
    }
}

InSpiteOfStop::InSpiteOfStop() {
    files::set_stop_question(nullptr);
}

InSpiteOfStop::~InSpiteOfStop() {
    files::set_stop_question(interrupt_requested);
}

// coroutine.resume, wrap and close

namespace {

// Equal in every lua_State of the process. Atomic, because nested sweeps open states on several threads at once, each
// of which writes them.
std::atomic<lua_CFunction> original_resume = nullptr;
std::atomic<lua_CFunction> original_close = nullptr;
std::atomic<lua_CFunction> original_create = nullptr;

int resume(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, 1);
    if (coroutine == nullptr) {
        return original_resume.load()(L);  // raises Lua's error about the argument
    }
    const RunningThread note(L, coroutine);
    return original_resume.load()(L);
}

int close(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, 1);
    if (coroutine == nullptr) {
        return original_close.load()(L);
    }
    if (interrupt_requested()) {
        raise_interrupted(L);  // its variables stay open: nothing of this chunk runs on
    }
    const RunningThread note(L, coroutine);
    return original_close.load()(L);
}

/// Closes the failed coroutine and raises its error here, with the position of the caller in front, as Lua does.
int raise_error_of(lua_State* L, lua_State* coroutine) {
    int status = lua_status(coroutine);
    if (status != LUA_OK && status != LUA_YIELD && !interrupt_requested()) {
        const RunningThread note(L, coroutine);
        status = lua_resetthread(coroutine);
        lua_xmove(coroutine, L, 1);
    }
    if (status != LUA_ERRMEM && lua_type(L, -1) == LUA_TSTRING) {
        luaL_where(L, 1);
        lua_insert(L, -2);
        lua_concat(L, 2);
    }
    return lua_error(L);
}

int wrapped(lua_State* L) {
    lua_State* coroutine = lua_tothread(L, lua_upvalueindex(1));
    lua_pushvalue(L, lua_upvalueindex(1));
    lua_insert(L, 1);
    const int results = resume(L);
    return lua_toboolean(L, -results) != 0 ? results - 1 : raise_error_of(L, coroutine);
}

int wrap(lua_State* L) {
    original_create.load()(L);
    lua_pushcclosure(L, wrapped, 1);
    return 1;
}

lua_CFunction original(lua_State* L, const char* name) {
    lua_getfield(L, -1, name);
    const lua_CFunction function = lua_tocfunction(L, -1);
    lua_pop(L, 1);
    return function;
}

}  // namespace

void open_coroutines(lua_State* L) {
    lua_getglobal(L, LUA_COLIBNAME);
    if (original(L, "resume") != resume) {
        original_resume = original(L, "resume");
        original_close = original(L, "close");
        original_create = original(L, "create");
        const luaL_Reg functions[] = {{"resume", resume}, {"close", close}, {"wrap", wrap}, {nullptr, nullptr}};
        luaL_setfuncs(L, functions, 0);
    }
    lua_pop(L, 1);
}

}  // namespace dinal::lua
