// Where a steady motion with stops is at the beginning of M's period: from release to release the motion depends on the
// place of rest alone, so that it is the root of a function of one number.
#pragma once

#include <optional>

#include "analysis/sine/single_sine.hpp"

namespace dinal::analysis::sine {

/// A start for the search, good to rounding as a rule; none when the motion has no stops, when it never moves, and when
/// its half periods are not opposites of each other.
std::optional<model::State> stopping_start(const SingleSine& sine);

}  // namespace dinal::analysis::sine
