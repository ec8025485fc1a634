// What a run that ended stuck may still become: whether anything can move its mass again, and how far it ever went.
#pragma once

#include "model/drive.hpp"
#include "motion/trajectory.hpp"

namespace dinal::motion {

/// A mass that is stuck at the end is at rest when M, as far as it is known, can never move it again: M is constant
/// from then on, or nowhere great enough, or has gone through a whole period and did not move it. The outcome says so
/// then, and its last stop is a rest. What no integrator can know, none of them tells.
void settle(Trajectory& trajectory, const model::Oscillator& system, const model::Drive& drive);

/// Where theta has its extremes on a belt, which no event tells: looked for between events and rows.
std::vector<model::Event> turns_on_belt(const Trajectory& run);

/// The greatest |theta| of the motion, not only of the rows; rad.
double peak(const Trajectory& trajectory);

}  // namespace dinal::motion
