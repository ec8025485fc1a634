// The modes of several bodies between which nothing but linear springs and viscous damping acts.
#pragma once

#include <vector>

#include "model/assembly.hpp"
#include "model/oscillator.hpp"

namespace dinal::motion::engine {

/// Each mode as a system of one body with I = 1: one for each pair of complex eigenvalues, or one without a spring for
/// each real eigenvalue. Growing modes, which only rounding can make, count as undamped.
std::vector<model::Oscillator> modes_of(const model::Assembly& system);

}  // namespace dinal::motion::engine
