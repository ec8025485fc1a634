// The classes and modules of this room. A new one is a file bind_*.cpp, its declaration and its row here, and its
// tests.
#pragma once

#include "lua/bind.hpp"

namespace dinal::api {

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

/// In the order of the manual.
inline constexpr lua::Section sections[] = {
    {"Systems", "", &system_functions},
    {"A system", "sys", &system_class},
    {"Laws of friction", "friction", &friction_module},
    {"A law of friction", "law", &friction_class},
    {"Springs", "spring", &spring_module},
    {"A spring", "spring", &spring_class},
    {"Excitations", "excitation", &excitation_module},
    {"An excitation", "e", &excitation_class},
    {"Integrators", "integrator", &integrator_module},
    {"An integrator", "integrator", &integrator_class},
    {"A run", "run", &run_class},
    {"A steady motion", "s", &steady_class},
    {"The energy of a run", "energy", &energy_class},
    {"Files", "", &load_functions},
    {"Theory", "theory", &theory_module},
    {"Vectors", "vector", &vector_module},
    {"A vector", "v", &vector_class},
    {"Data", "data", &data_module},
    {"Named columns", "d", &data_class},
    {"Identification", "", &identify_functions},
    {"A fit", "fit", &fit_class},
    {"Progress", "", &progress_functions},
    {"Plots", "", &plot_functions},
    {"A picture", "picture", &picture_class},
};

}  // namespace dinal::api
