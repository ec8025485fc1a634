// Lua states besides that of the program, in which other threads run users' functions.
#pragma once

#include <memory>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Tells how the libraries of dinal are opened in a new state. Once, when they are opened in the first.
void set_library(void (*open)(lua_State* L)) noexcept;

struct StateCloser {
    void operator()(lua_State* L) const { lua_close(L); }
};
using OwnedState = std::unique_ptr<lua_State, StateCloser>;

/// A new state with all that a script finds in `like` when it begins: the libraries, safe mode and the limit of memory,
/// the places where modules are looked for. Raises in `like` when there is no memory for it.
OwnedState new_state_like(lua_State* like);

/// Makes os.exit an error in a state of a worker.
void forbid_exit(lua_State* L);

/// Raises when this is a worker's thread, where nobody could tell whose picture or file it is: "CALL is not possible
/// within a sweep; ...".
void refuse_in_worker(lua_State* L, const char* call);

}  // namespace dinal::lua
