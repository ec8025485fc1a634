// Objects as the prompt shows them: the text of `tostring`, and derived quantities.
#pragma once

#include <string>

#include "lua/vector.hpp"
#include "terminal/display.hpp"

namespace dinal::api {

/// The parameters of the system at `index` and derived quantities, one a line.
std::string system_card(lua_State* L, int index, const terminal::Display& screen);

/// M(t) as a formula, one line for each term, and its jumps and kinks.
std::string excitation_card(lua_State* L, int index, const terminal::Display& screen);

/// The method with all its options, including defaults.
std::string integrator_card(lua_State* L, int index, const terminal::Display& screen);

/// All elements if there are at most `whole`; otherwise `ends` elements at both ends, and the length.
std::string vector_text(const lua::Vector& v, std::size_t whole, std::size_t ends);

/// The ends of the vector that fit on a line, and its length.
std::string vector_card(lua_State* L, int index, const terminal::Display& screen);

/// The summary, wrapped.
std::string run_card(lua_State* L, int index, const terminal::Display& screen);

/// The balance, without remarks that do not fit.
std::string energy_card(lua_State* L, int index, const terminal::Display& screen);

}  // namespace dinal::api
