// The integrators' entry points, for simulate() only.
#pragma once

#include "motion/simulate.hpp"

namespace dinal::motion {

namespace spectral {
Trajectory run(const Problem& problem, const Spectral& options);
}
namespace rk4 {
Trajectory run(const Problem& problem, const Rk4& options);
}
namespace dinal1989 {
Trajectory run(const Problem& problem, const Dinal1989& options);
}

}  // namespace dinal::motion
