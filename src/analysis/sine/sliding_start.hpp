// Where a steady motion without stops is at the beginning of M's period, by Den Hartog's closed form: a start for the
// search that is the answer wherever the mass does not stop.
#pragma once

#include <optional>

#include "analysis/sine/single_sine.hpp"

namespace dinal::analysis::sine {

/// None where such a motion would stop, as far as one look at its slide tells.
std::optional<model::State> sliding_start(const SingleSine& sine);

}  // namespace dinal::analysis::sine
