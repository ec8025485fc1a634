// Systems with all kinds of more in them by lot, compared with the integrator of mixed_truth.hpp.
#pragma once

namespace dinal::truth {

/// Each case by spectral; fails with the case written down. Cases whose decisions are too close to call are counted.
void check_random_mixed(int cases);

}  // namespace dinal::truth
