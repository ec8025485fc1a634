// Ctrl-C: stops the Lua code that runs, in coroutines too, and through interrupt_requested() the C++ stepping loop.
//
// No hook is set until the signal comes: its handler puts one on the thread that is running then. That thread is known
// because coroutine.resume, wrap and close are replaced by functions that note it (open_coroutines).
#pragma once

#include <lua.hpp>

namespace dinal {

/// Installs the SIGINT handler. A second Ctrl-C within a second, while the chunk has still not stopped, ends the
/// process with exit code 130.
void install_interrupt_handler();

/// Ctrl-C was pressed since the last InterruptScope began. A stepping loop asks this now and then.
[[nodiscard]] bool interrupt_requested() noexcept;

/// What is raised in the running code: the string "interrupted!", without position.
[[noreturn]] void raise_interrupted(lua_State* L);

/// While it lives, Ctrl-C raises "interrupted!" again and again in what runs on `L`, so that no pcall can swallow it.
/// One for each chunk, around its lua_pcall at the top level. Outside of it, Ctrl-C only sets the flag.
class InterruptScope {
public:
    explicit InterruptScope(lua_State* L);
    ~InterruptScope();
    InterruptScope(const InterruptScope&) = delete;
    InterruptScope& operator=(const InterruptScope&) = delete;

private:
    lua_State* L_;
};

/// Replaces coroutine.resume, wrap and close by functions that do the same and note which thread runs.
void open_coroutines(lua_State* L);

}  // namespace dinal
