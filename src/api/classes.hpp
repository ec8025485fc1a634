// The classes and modules of this room: one registration function and one or two descriptions for each file.
#pragma once

#include "lua/bind.hpp"

namespace dinal::api {

/// One for each bind_*.cpp; called with the table `dinal` on the top of the stack, which stays.
void register_system(lua_State* L);
void register_friction(lua_State* L);
void register_spring(lua_State* L);
void register_excitation(lua_State* L);
void register_integrator(lua_State* L);
void register_run(lua_State* L);
void register_energy(lua_State* L);
void register_load(lua_State* L);
void register_theory(lua_State* L);
void register_vector(lua_State* L);
void register_data(lua_State* L);
void register_steady(lua_State* L);
void register_identify(lua_State* L);
void register_progress(lua_State* L);
void register_plot(lua_State* L);

// Defined in the bind_*.cpp of that name.
extern const lua::Class system_functions;    // system, nondimensional
extern const lua::Class system_class;        // sys
extern const lua::Class friction_module;     // friction.stribeck ...
extern const lua::Class friction_class;      // laws
extern const lua::Class spring_module;       // spring.polynomial
extern const lua::Class spring_class;        // springs
extern const lua::Class excitation_module;   // excitation.harmonic ...
extern const lua::Class excitation_class;    // e
extern const lua::Class integrator_module;   // integrator.rk4 ...
extern const lua::Class integrator_class;    // integrators
extern const lua::Class run_class;           // run
extern const lua::Class energy_class;        // result of run:energy()
extern const lua::Class load_functions;      // load
extern const lua::Class theory_module;       // theory.magnification ...
extern const lua::Class vector_module;       // vector{...}, vector.linspace
extern const lua::Class vector_class;        // v
extern const lua::Class steady_class;        // result of sys:steady{ ... }
extern const lua::Class identify_functions;  // identify
extern const lua::Class fit_class;           // result of identify{ ... }
extern const lua::Class data_module;         // data{ ... }
extern const lua::Class data_class;          // d
extern const lua::Class plot_functions;      // plot
extern const lua::Class picture_class;       // result of plot{ ..., show = false }
extern const lua::Class progress_functions;  // progress

}  // namespace dinal::api
