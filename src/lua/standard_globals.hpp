// The table `dinal`, and the standard globals of Lua and dinal as opposed to the user's.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lua/lua_headers.hpp"

namespace dinal::lua {

/// Makes the table and leaves it on the top of the stack.
void make_dinal_table(lua_State* L);

/// Pushes the table of make_dinal_table(), even if the user has changed that global.
void push_dinal_table(lua_State* L);

/// Returns whether the value is the table of all globals.
bool is_global_table(lua_State* L, int index);

/// Copies all fields of the table below the top into the table on the top.
void copy_fields(lua_State* L);

/// Records the standard globals. Call when all globals of Lua and dinal exist.
void note_standard_globals(lua_State* L);

/// Pushes a table of the standard globals: name -> value.
void push_standard_globals(lua_State* L);

/// Pushes a table of the libraries' initial fields: library -> copy of its fields.
void push_standard_fields(lua_State* L);

/// Returns whether a standard global has been replaced; with `field`, a field of a standard library, such as math.pi.
bool is_overwritten(lua_State* L, std::string_view name, std::string_view field = {});

/// Returns whether the table `dinal` also has this global.
bool is_of_dinal(lua_State* L, std::string_view name);

/// The names of globals that are not standard or have been replaced; sorted.
std::vector<std::string> users_globals(lua_State* L);

/// Removes the user's globals and restores the standard ones.
void reset_globals(lua_State* L);

// Output of scripts must not mix with the progress line.

/// Replaces print, io.write and file:write, if they exist, by functions that erase the progress line first.
void open_terminal_output(lua_State* L);

}  // namespace dinal::lua
