// Where a motion without stops would be at the beginning of M's period, by Den Hartog's closed form: a start for the
// search that is the answer wherever the mass does not stop.
#pragma once

#include <optional>

#include "analysis/steady.hpp"

namespace dinal::analysis {

/// Of a linear spring and even friction of Coulomb under one sine; else none.
std::optional<model::State> sliding_start(const SteadyQuestion& question);

}  // namespace dinal::analysis
