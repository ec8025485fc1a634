// What is known about an error besides its message, from where it is raised to where it is printed.
//
// The value that a user's pcall sees stays a plain string, so what is known stands beside it, in the Lua state.
#pragma once

#include <string_view>

#include "lua/lua_headers.hpp"
#include "text/expected.hpp"

namespace dinal::lua {

/// To be called with an error of ours when it is raised. The last few are remembered.
void remember_facts(lua_State* L, const text::Error& error);

/// The error of ours that the message tells, nullptr when it is of Lua or of the user. A message that was raised again
/// may have more words before it (the position of coroutine.wrap or error) and after it (a traceback).
const text::Error* facts_of(lua_State* L, std::string_view message);

}  // namespace dinal::lua
