// The table in which functions get the states of a run: the same all through it, with no other fields than these.
#pragma once

#include <span>
#include <string>

struct lua_State;

namespace dinal::lua {

/// Pushes a table with a number in each of these fields; any other one is an error that names them: "there is no state
/// 'x'; there is e".
void push_state_table(lua_State* L, std::span<const std::string> names, const char* what = "state");

}  // namespace dinal::lua
