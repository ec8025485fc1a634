// Runs the system of one body with the engine for several: the smallest assembly.
#pragma once

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// The smallest assembly: this body on the ground.
model::Assembly assembly_of(const model::Oscillator& system);

/// Runs the problem. The columns of its states stand behind the others.
Trajectory run(const Problem& problem, const Cut& cut);

}  // namespace dinal::motion::engine
