// The integrators' entry points, for simulate() only.
#pragma once

#include "motion/simulate.hpp"

namespace dinal {

Trajectory run(const Problem& problem, const Spectral& options);
Trajectory run(const Problem& problem, const Rk4& options);
Trajectory run(const Problem& problem, const Dinal1989& options);

}  // namespace dinal
