// What theory.* does, one C function each; bind_theory.cpp documents them.
#pragma once

#include "lua/lua_headers.hpp"

namespace dinal::api::theory_functions {

// Free motion: theory_free_functions.cpp
int free_response(lua_State* L);
int extremes(lua_State* L);
int time_to_rest(lua_State* L);
int rest_position(lua_State* L);
int half_cycle(lua_State* L);
int logarithmic_decrement(lua_State* L);
int zeta_from_decrement(lua_State* L);
int friction_decrement(lua_State* L);
int identify(lua_State* L);

// Steady motion, and steps: theory_forced_functions.cpp
int magnification(lua_State* L);
int phase_lag(lua_State* L);
int transmissibility(lua_State* L);
int equivalent_damping(lua_State* L);
int equivalent_zeta(lua_State* L);
int linearised(lua_State* L);
int friction_work(lua_State* L);
int growth_at_resonance(lua_State* L);
int den_hartog(lua_State* L);
int den_hartog_fundamental(lua_State* L);
int stop_boundary(lua_State* L);
int step_limit(lua_State* L);

}  // namespace dinal::api::theory_functions
