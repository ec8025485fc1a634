// Runs a plain system with the general engine.
#pragma once

#include "motion/engine/run.hpp"

namespace dinal::motion::engine {

/// Runs the problem. The columns of the user's states follow the others.
Run run(const Problem& problem, const Cut& cut);

}  // namespace dinal::motion::engine
