// Additional Lua states, in which other threads run users' functions.
#pragma once

#include <memory>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Sets the function that opens dinal's libraries in a new state. Call once, when they are opened in the first.
void set_library(void (*open)(lua_State* L)) noexcept;

struct StateCloser {
    void operator()(lua_State* L) const { lua_close(L); }
};
using OwnedState = std::unique_ptr<lua_State, StateCloser>;

/// A new state equal to `like` at the start of a script: libraries, safe mode, memory limit, module paths. Raises an
/// error in `like` if memory is insufficient.
OwnedState new_state_like(lua_State* like);

/// Makes os.exit an error in a worker's state.
void forbid_exit(lua_State* L);

/// Raises "CALL is not possible within a sweep; ..." on a worker's thread, where pictures and files could not be
/// attributed.
void refuse_in_worker(lua_State* L, const char* call);

}  // namespace dinal::lua
