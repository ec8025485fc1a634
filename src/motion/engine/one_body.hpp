// Runs the system of one body with the engine for several: the smallest assembly.
#pragma once

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// How a run is cut into stretches.
struct Cut {
    double tolerance = 1e-12;
    double longest = model::never;  ///< stretch, time units
    double step = 0;                ///< of the classical Runge-Kutta method; 0: collocation
};

/// The smallest assembly: this body on the ground.
model::Assembly assembly_of(const model::Oscillator& system);

/// Runs the problem. The columns of its states stand behind the others.
Trajectory run(const Problem& problem, const Cut& cut);

}  // namespace dinal::motion::engine
