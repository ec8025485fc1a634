// Systems with springs and walls of all kinds by lot, compared with the integrator of stops_truth.hpp.
#pragma once

namespace dinal::truth {

enum class Lots { springs, walls };

/// Each case by spectral within 1e-10, each sixth by rk4 at its own accuracy; fails with the case written down. Cases
/// whose decisions are too close to call are counted, and may be one in ten.
void check_random_stops(Lots kind, int cases);

}  // namespace dinal::truth
