// The steady motion under an M with a memory. What a delay, a relay or a controller that samples remembers is a part
// of the state of which theta and velocity say nothing, so there is no map of these: the run itself goes on until it
// repeats itself. docs/theory.md, section 10.
#pragma once

#include "analysis/steady.hpp"

namespace dinal::analysis::settling {

/// Where a run from `initial` gets. It has no multipliers; `settled` is one period of it.
SteadyMotion settled_motion(const SteadyQuestion& question, const motion::Monitor& monitor);

/// Whether a motion that was found by theta and velocity alone goes on so in one run of some periods.
bool goes_on(const SteadyQuestion& question, const SteadyMotion& motion, const motion::Monitor& monitor);

}  // namespace dinal::analysis::settling
