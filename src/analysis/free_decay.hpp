// A free decay at the times of a record, from the closed form of each swing (theory/theory_free.hpp): a thousand
// samples cost a few hundred sines.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "model/oscillator.hpp"

namespace dinal::analysis {

/// Returns theta at these increasing times, starting from `initial` at the first one. Requires a linear spring, Coulomb
/// friction and less than critical damping. With `rests_at` the mass rests at that extreme (0: the first) regardless of
/// the friction limit.
Eigen::VectorXd free_decay(const model::Oscillator& system, const model::State& initial, std::span<const double> times,
                           std::optional<double> rests_at = {});

}  // namespace dinal::analysis
