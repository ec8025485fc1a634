// Words about what was typed that is no error but probably not what was meant.
#pragma once

#include <string>

#include "lua/lua_headers.hpp"
#include "prompt/chunk.hpp"

namespace dinal::prompt {

/// The expression is the name of a global that does not exist, or the word help.
std::string name_notice(lua_State* L, const Chunk& chunk);

/// The expression, which is nil, is an element or a field that is not there: run.theta[0], run.events[1].theat.
std::string element_notice(lua_State* L, const Chunk& chunk);

/// A line that Lua takes for the beginning of a longer one, and hardly is: "run:events" waits for arguments that a
/// field never gets and a method may have been expected to do without; "5%".
std::string unfinished_notice(lua_State* L, const std::string& text);

/// A local variable at the top level that nothing after it uses: it is lost.
std::string local_notice(const std::string& text);

/// An option, or a variable, becomes a global that does not exist, integrator = rk4: no error in Lua, but hardly meant.
std::string nil_notice(lua_State* L, const std::string& text);

/// "x = 1,5"
std::string comma_notice(const std::string& text);

/// A name that Lua or dinal brings, and that the text has given another value: system = 3, math.pi = 3.
std::string overwritten_notice(lua_State* L, const std::string& text);

/// math.max of one vector, which is that vector; the value is at `index`.
std::string greatest_notice(lua_State* L, int index, const Chunk& chunk);

/// On standard error, unless it is empty.
void say_notice(const std::string& notice);

/// For lua::look_at_options: which option of a call in a file is nil by a misspelt name, once for each line.
void tell_nil_option(lua_State* L);

/// --strict: reading a global variable that does not exist is an error, and so is such an option.
void be_strict(lua_State* L);

}  // namespace dinal::prompt
