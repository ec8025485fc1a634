// Stops a chunk from outside: Ctrl-C, and the limits of safe_mode.hpp. It stops the running Lua code, including
// coroutines, and through stop_requested() the C++ stepping loop.
//
// No hook is set until a stop is requested: then the signal handler sets one on the running Lua thread. That thread is
// known because coroutine.resume, wrap and close are replaced by functions that record it (open_coroutines).
#pragma once

#include <pthread.h>
#include <csignal>

#include <atomic>
#include <cstdint>
#include <string>

#include "lua/lua_headers.hpp"
#include "text/not_copied.hpp"

namespace dinal::lua {

// The time limit of a chunk, in processor time, so that a busy machine does not matter. A chunk that only waits may
// take longest_wait times as long.
//
// A timer checks the clocks. After the deadline it stops the chunk like Ctrl-C. Code that cannot be stopped in this way
// (an endless pattern search, a finalizer) ends the whole program a second later.

inline constexpr int longest_wait = 10;

/// Sets the time limit for the whole process. Call once, on the thread that runs Lua.
void set_time_limit(double seconds);

/// The limit in seconds; 0: none.
[[nodiscard]] double time_limit() noexcept;

/// The time limit counts while this object lives. Nested objects have no effect.
class TimeAllowance : text::NotCopied {
public:
    TimeAllowance();
    ~TimeAllowance();
};

enum class Stop { none, interrupted, time, memory };

/// Installs the SIGINT handler. A second Ctrl-C, if the chunk has had time to stop but has not, ends the process with
/// exit code 130.
void install_interrupt_handler();
/// Installs only the handlers through which other stop requests reach workers and file reading.
void install_stop_handlers();

/// Sets a signal handler that also interrupts system calls.
void set_handler(int signal, void (*handler)(int));

/// The reason to stop since the last InterruptScope began. Stepping loops call this now and then.
[[nodiscard]] Stop stop_requested() noexcept;
/// Returns whether to stop for any reason, including that this worker's task is given up.
[[nodiscard]] bool interrupt_requested() noexcept;

/// Stops the running code, unless it is already being stopped. Call on Lua's thread; allowed in a signal handler.
void request_stop(Stop reason) noexcept;

/// Like request_stop(), but not for signal handlers; sets stopped_at() to the present position.
void stop_here(Stop reason) noexcept;

/// Makes stop_after_refusal() run before the next Lua instruction on this thread.
void look_at_next_instruction() noexcept;

/// Raises the string "interrupted!" or "limit reached!" in the running code, without position.
[[noreturn]] void raise_interrupted(lua_State* L);

/// The place of the stop, as "lab.lua:3"; "" outside of any Lua function.
std::string stopped_at();

/// Returns whether an InterruptScope exists.
[[nodiscard]] bool chunk_runs() noexcept;

/// While this object lives, a stop is raised repeatedly in the code on `L`, so that no pcall can swallow it. Use one
/// for each chunk, around its outermost lua_pcall; the time limit runs meanwhile. Outside, Ctrl-C only sets the flag. A
/// nested scope belongs to the outer one, so that a Ctrl-C between two of them is not lost.
class InterruptScope : text::NotCopied {
public:
    explicit InterruptScope(lua_State* L);
    ~InterruptScope();

private:
    lua_State* L_;
    bool within_;  ///< whether it is nested
    TimeAllowance time_;
};

/// The present task of a worker, so that another thread can give it up when it takes too long; later tasks are not
/// affected.
struct WorkerWatch {
    std::atomic<std::uint64_t> task = 0, given_up = 0;  ///< task numbers, from 1
    std::atomic<double> since = 0;                      ///< start of the task, seconds of the watcher's clock
    const WorkerWatch* outer = nullptr;                 ///< watch of the worker that waits for this one

    bool has_given_up() const noexcept { return given_up != 0 && given_up == task; }
    bool must_stop() const noexcept { return has_given_up() || (outer != nullptr && outer->must_stop()); }
};
/// The watch of this thread, or nullptr.
[[nodiscard]] const WorkerWatch* watch_here() noexcept;

/// Marks a thread that runs Lua in its own state. While this object lives, a stop requested here or by a nudge reaches
/// the code on `L`, and no progress is shown. The InterruptScope is that of the program.
class WorkerScope : text::NotCopied {
public:
    explicit WorkerScope(lua_State* L, const WorkerWatch* watch = nullptr);
    ~WorkerScope();

private:
    std::atomic<lua_State*> running_;
    std::atomic<lua_State*>* outer_;
    const WorkerWatch* outer_watch_;
};
[[nodiscard]] bool in_worker() noexcept;
/// Makes that thread check for a stop request. It must not have been joined.
void nudge(pthread_t worker) noexcept;

/// While this object lives, new threads block all signals except nudge(): Ctrl-C is for the program's own thread.
class NoSignalsForNewThreads : text::NotCopied {
public:
    NoSignalsForNewThreads();
    ~NoSignalsForNewThreads();

private:
    sigset_t before_{};
};

/// Replaces coroutine.resume, wrap and close by functions that also record the running thread.
void open_coroutines(lua_State* L);

/// While this object lives, files are read and written completely even if the script was stopped.
class InSpiteOfStop : text::NotCopied {
public:
    InSpiteOfStop();
    ~InSpiteOfStop();
};

/// Records `callee`, called from `caller`, as the running Lua thread for the handler of Ctrl-C, while this object
/// lives.
class RunningThread : text::NotCopied {
public:
    RunningThread(lua_State* caller, lua_State* callee);
    ~RunningThread();

private:
    lua_State* caller_;
};

}  // namespace dinal::lua
