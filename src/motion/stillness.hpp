// The future of a run that ended stuck: whether anything can move the mass again. Also the peak of a motion.
#pragma once

#include "model/drive.hpp"
#include "motion/run.hpp"

namespace dinal::motion {

/// A mass stuck at the end is at rest if M can never move it again: M is constant from then on, nowhere large enough,
/// or has completed a period without moving it. Sets the outcome and turns the last stop into a rest. This is done once
/// here, as integrators do not know the future of M.
void settle(Run& run, const model::Oscillator& system, const model::Drive& drive);

/// The turns of theta on a belt, which are not recorded as events. They are searched between events and rows.
std::vector<model::Event> turns_on_belt(const Run& run);

/// Returns whether the mass stands at the end of the run: its velocity is 0, or the rounding of its place where a load
/// holds it at a jump.
bool stands_at_stop(const Run& run);

/// The greatest |theta| of the motion, also between the rows; rad.
double peak(const Run& run);

}  // namespace dinal::motion
