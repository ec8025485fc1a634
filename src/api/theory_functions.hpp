// What theory.* does beyond one formula, a function each; bind_theory.cpp documents them.
#pragma once

#include <array>

#include "lua/lua_headers.hpp"

namespace dinal::api::theory_functions {

// Free motion: theory_free_functions.cpp
int free_response(lua_State* L);
int extremes(lua_State* L);
int time_to_rest(lua_State* L);
int rest_position(lua_State* L);
int half_cycle(lua_State* L);
std::array<double, 2> identify(double X0, double X1, double X2);

// Steady motion, and steps: theory_forced_functions.cpp
std::array<double, 2> linearised(double r, double friction_ratio, double zeta);
int den_hartog(lua_State* L);
int den_hartog_fundamental(lua_State* L);
double stop_boundary(double r, double zeta, double factor);
int step_limit(lua_State* L);

}  // namespace dinal::api::theory_functions
