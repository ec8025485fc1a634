// A free decay at the times of a record, by the closed form of each swing (theory/theory_free.hpp): a thousand samples
// in the time of a few hundred sines.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "model/oscillator.hpp"

namespace dinal::analysis {

/// theta at each of these increasing times, from `initial` at the first one. A linear spring and friction of Coulomb.
/// With `rests_at` the mass rests at that one of its extremes (0: the first) whatever friction can hold; underdamped.
Eigen::VectorXd free_decay(const model::Oscillator& system, const model::State& initial, std::span<const double> times,
                           std::optional<double> rests_at = {});

}  // namespace dinal::analysis
