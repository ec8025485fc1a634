// Random systems with combined features, compared with the integrator of mixed_truth.hpp.
#pragma once

namespace dinal::truth {

/// Runs each case with spectral; a failure prints the case. Counts cases with decisions too close to call.
void check_random_mixed(int cases);

}  // namespace dinal::truth
