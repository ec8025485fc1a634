// What stops a chunk from outside: Ctrl-C, and the limits of limits.hpp. It stops the Lua code that runs, in coroutines
// too, and through stop_requested() the C++ stepping loop.
//
// No hook is set until then: the handler of the signal puts one on the thread that is running. That thread is known
// because coroutine.resume, wrap and close are replaced by functions that note it (open_coroutines).
#pragma once

#include <pthread.h>
#include <csignal>

#include <atomic>
#include <cstdint>
#include <string>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

// How long a chunk may run, in processor time: a busy machine must not decide. A chunk that only waits may do so
// longest_wait times as long.
//
// A timer looks at the clocks. When the time is over it stops what runs, as Ctrl-C would. What cannot be
// stopped so (a search for a pattern that never ends, a finalizer) is ended with the whole program a second later.

inline constexpr int longest_wait = 10;

/// From now on. Once, for the whole process, from the thread that runs Lua.
void set_time_limit(double seconds);

/// 0 when there is none.
[[nodiscard]] double time_limit() noexcept;

/// While it lives, the time runs. One within another changes nothing.
class TimeAllowance {
public:
    TimeAllowance();
    ~TimeAllowance();
    TimeAllowance(const TimeAllowance&) = delete;
    TimeAllowance& operator=(const TimeAllowance&) = delete;
};

enum class Stop { none, interrupted, time, memory };

/// Installs the SIGINT handler. A second Ctrl-C, when the chunk has had a moment and has still not stopped, ends the
/// process with exit code 130.
void install_interrupt_handler();
/// The rest of it: what a stop that is requested otherwise needs to reach workers and the reading of files.
void install_stop_handlers();

/// What the process does at a signal, also while it waits in a system call.
void set_handler(int signal, void (*handler)(int));

/// Why what runs shall stop, since the last InterruptScope began. A stepping loop asks this now and then.
[[nodiscard]] Stop stop_requested() noexcept;
/// It shall, whatever the reason; also when this is a worker that is given up.
[[nodiscard]] bool interrupt_requested() noexcept;

/// Stops what runs, unless it is being stopped already. To be called on the thread of Lua, also in a signal handler.
void request_stop(Stop reason) noexcept;

/// The same, not in a signal handler: stopped_at() is what runs now.
void stop_here(Stop reason) noexcept;

/// Has settle_refusal() called before the next instruction of Lua on this thread.
void look_at_next_instruction() noexcept;

/// What is raised in the running code: the string "interrupted!" or "limit reached!", without position.
[[noreturn]] void raise_interrupted(lua_State* L);

/// "lab.lua:3" where the running code was stopped, "" when it was in no Lua function.
std::string stopped_at();

/// An InterruptScope lives.
[[nodiscard]] bool chunk_runs() noexcept;

/// While it lives, a stop is raised again and again in what runs on `L`, so that no pcall can swallow it. One for each
/// chunk, around its lua_pcall at the top level; its time runs meanwhile. Outside of it, Ctrl-C only sets the flag.
/// One within another is a part of it: a Ctrl-C between two of them is not lost.
class InterruptScope {
public:
    explicit InterruptScope(lua_State* L);
    ~InterruptScope();
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;

private:
    lua_State* L_;
    bool within_;  ///< another one
    TimeAllowance time_;
};

/// What a worker is at, for a thread that gives it up when it takes too long: that task only, whatever comes next.
struct WorkerWatch {
    std::atomic<std::uint64_t> task = 0, given_up = 0;  ///< their numbers, from 1
    std::atomic<double> since = 0;       ///< the beginning of the task, in seconds of the watcher's clock
    const WorkerWatch* outer = nullptr;  ///< of a worker that waits for this one

    [[nodiscard]] bool has_given_up() const noexcept { return given_up != 0 && given_up == task; }
    [[nodiscard]] bool must_stop() const noexcept { return has_given_up() || (outer != nullptr && outer->must_stop()); }
};
/// Of this thread; nullptr when nobody watches it.
[[nodiscard]] const WorkerWatch* watch_here() noexcept;

/// A thread besides the program's own, which runs Lua in a state of its own: while it lives, a stop that is requested
/// here, or nudged, reaches what runs on `L`, and no progress is shown. The InterruptScope is that of the program.
class WorkerScope {
public:
    explicit WorkerScope(lua_State* L, const WorkerWatch* watch = nullptr);
    ~WorkerScope();
    WorkerScope(const WorkerScope&) = delete;
    WorkerScope& operator=(const WorkerScope&) = delete;

private:
    std::atomic<lua_State*> running_;
    std::atomic<lua_State*>* outer_;
    const WorkerWatch* outer_watch_;
};
/// This thread is one.
[[nodiscard]] bool in_worker() noexcept;
/// Makes that thread look whether a stop is requested. It must not have been joined.
void nudge(pthread_t worker) noexcept;

/// While it lives, threads that are started here get no signal but a nudge: Ctrl-C is for the program's own.
class SignalsForOthers {
public:
    SignalsForOthers();
    ~SignalsForOthers();
    SignalsForOthers(const SignalsForOthers&) = delete;
    SignalsForOthers& operator=(const SignalsForOthers&) = delete;

private:
    sigset_t before_{};
};

/// Replaces coroutine.resume, wrap and close by functions that do the same and note which thread runs.
void open_coroutines(lua_State* L);

/// While it lives, files are read and written to their end although the script was stopped.
class InSpiteOfStop {
public:
    InSpiteOfStop();
    ~InSpiteOfStop();
    InSpiteOfStop(const InSpiteOfStop&) = delete;
    InSpiteOfStop& operator=(const InSpiteOfStop&) = delete;
};

/// Which Lua thread runs, for the handler of Ctrl-C: while it lives, `callee` does, called from `caller`.
class RunningThread {
public:
    RunningThread(lua_State* caller, lua_State* callee);
    ~RunningThread();
    RunningThread(const RunningThread&) = delete;
    RunningThread& operator=(const RunningThread&) = delete;

private:
    lua_State* caller_;
};

}  // namespace dinal::lua
