// Runs a plain system by the general engine.
#pragma once

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Runs the problem. The columns of its states stand behind the others.
Trajectory run(const Problem& problem, const Cut& cut);

}  // namespace dinal::motion::engine
