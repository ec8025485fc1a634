// By how much a steady motion lags behind the M that drives it.
#pragma once

#include <optional>

#include "model/excitation.hpp"
#include "motion/trajectory.hpp"

namespace dinal::analysis {

/// The lag of the fundamental of theta behind that of M in the period of M before `until`, rad, from -pi/2 to 3 pi/2.
/// None when M has no fundamental or depends on the motion, or the rows are too few where they are needed. User
/// functions are not asked again: their M is read off the rows.
std::optional<double> phase_lag(const motion::Trajectory& trajectory, const model::Excitation& excitation,
                                double period, double until);

}  // namespace dinal::analysis
