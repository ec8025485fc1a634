// Objects as the prompt shows them, for the eye: what `tostring` says in Lua text, and what follows from it.
#pragma once

#include <string>

#include "lua/vector.hpp"
#include "terminal/display.hpp"

namespace dinal::api {

/// The parameters of the system at `index` and what follows from them, a line each.
std::string system_card(lua_State* L, int index, const terminal::Display& screen);

/// M(t) as a formula, a line for each term, and the times at which it jumps or kinks.
std::string excitation_card(lua_State* L, int index, const terminal::Display& screen);

/// The method with all its options, those that were not given, too.
std::string integrator_card(lua_State* L, int index, const terminal::Display& screen);

/// All elements if there are not more than `whole`; otherwise so many of both ends, and the length.
std::string vector_text(const lua::Vector& v, std::size_t whole, std::size_t ends);

/// The ends of the vector that fit on a line, and its length.
std::string vector_card(lua_State* L, int index, const terminal::Display& screen);

/// The summary, over more than one line when it must be.
std::string run_card(lua_State* L, int index, const terminal::Display& screen);

/// The balance, without the remarks that do not fit.
std::string energy_card(lua_State* L, int index, const terminal::Display& screen);

}  // namespace dinal::api
