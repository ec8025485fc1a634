// The map of the Lua API: everything that Lua can see is registered, and listed in the manual, from here.
#pragma once

#include <span>

#include "lua/bind.hpp"

namespace dinal {

/// Makes the table `dinal` (also for require "dinal"), copies its members into _G and tracks coroutines for Ctrl-C.
void open_library(lua_State* L);

/// One for each bind_*.cpp: called with the table `dinal` on the top of the stack, which it leaves there.
void register_system(lua_State* L);
void register_excitation(lua_State* L);
void register_integrator(lua_State* L);
void register_run(lua_State* L);
void register_energy(lua_State* L);
void register_trajectory(lua_State* L);
void register_theory(lua_State* L);
void register_vector(lua_State* L);
void register_progress(lua_State* L);
void register_plot(lua_State* L);
void register_help(lua_State* L);

/// Everything that Lua can see, in the order of the manual. A section is a module, a class of objects, or functions.
struct Section {
    const char* title;   ///< "excitation", "An excitation"
    const char* prefix;  ///< what stands before a member: "excitation.", "e:", ""
    const Class* description;
};
std::span<const Section> sections();

// Defined in the bind_*.cpp of that name.
extern const Class system_functions;    // system, nondimensional
extern const Class system_class;        // sys
extern const Class excitation_module;   // excitation.harmonic ...
extern const Class excitation_class;    // e
extern const Class integrator_module;   // integrator.rk4 ...
extern const Class integrator_class;    // what they return
extern const Class run_class;           // run
extern const Class energy_class;        // what run:energy() returns
extern const Class trajectory_module;   // trajectory.load
extern const Class theory_module;       // theory.magnification ...
extern const Class vector_module;       // vector{...}, vector.linspace
extern const Class vector_class;        // v
extern const Class plot_functions;      // plot
extern const Class picture_class;       // what plot{ ..., show = false } returns
extern const Class progress_functions;  // progress
extern const Class help_functions;      // help

}  // namespace dinal
