// The search on the period map of one plain body that is linear between events.
#pragma once

#include "analysis/steady.hpp"

namespace dinal::analysis {

/// The motion that a run from the start of the question leads to. `near`: the start is near the answer, and the motion
/// there is wanted if it is stable. Requires PeriodMap::applies_to().
SteadyMotion motion_by_periods(const SteadyQuestion& question, bool near, const motion::Monitor& monitor);

}  // namespace dinal::analysis
