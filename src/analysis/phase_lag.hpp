// The phase lag of a steady motion behind M.
#pragma once

#include <optional>

#include "model/excitation.hpp"
#include "motion/run.hpp"

namespace dinal::analysis {

/// The lag of theta's fundamental behind that of M over the period of M before `until`, rad, from -pi/2 to 3 pi/2. None
/// if M has no fundamental or depends on the motion, or if there are too few rows. User functions are not called again:
/// their M is read from the rows.
std::optional<double> phase_lag(const motion::Run& run, const model::Excitation& excitation, double period,
                                double until);

}  // namespace dinal::analysis
