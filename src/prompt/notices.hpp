// Notices on input that is valid but probably not intended. Each function returns the notice, or "".
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "prompt/chunk.hpp"

namespace dinal::prompt {

/// For an expression that is an unknown global, or the word help.
std::string name_notice(lua_State* L, const Chunk& chunk);

/// For an expression that is nil because an element or field does not exist: run.theta[0], run.events[1].theat.
std::string element_notice(lua_State* L, const Chunk& chunk);

/// For an incomplete line that is probably not meant to continue: "run:events" waits for arguments that a field never
/// has, and that a method may not need; "5%".
std::string unfinished_notice(lua_State* L, const std::string& text);

/// For a local variable at the top level without further use: it is lost.
std::string local_notice(const std::string& text);

/// For an option or variable set to an unknown global, integrator = rk4: nil in Lua, but probably not intended.
std::string nil_notice(lua_State* L, const std::string& text);

/// For "x = 1,5".
std::string comma_notice(const std::string& text);

/// For a standard name with a new value: system = 3, math.pi = 3.
std::string overwritten_notice(lua_State* L, const std::string& text);

/// Prints a notice on standard error, unless empty.
void say_notice(const std::string& notice);

/// For lua::look_at_options: reports an option that is nil because of a misspelt name, once for each line of a file.
void report_nil_option(lua_State* L);

/// --strict: makes unknown globals, also in options, errors.
void be_strict(lua_State* L);

}  // namespace dinal::prompt
