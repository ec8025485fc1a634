// The mean and the fundamental of a steady motion from its friction. As k theta + C theta' + I theta'' is M minus
// friction, both follow from the integrals of M and of friction, which is constant during a slide and M - k theta
// during a stick. The motion between events is not needed.
#pragma once

#include <complex>
#include <optional>

#include "analysis/steady.hpp"

namespace dinal::analysis {

struct Fundamental {
    double mean = 0;            ///< mean of theta
    std::complex<double> wave;  ///< (2/T) times the integral of theta e^(-i omega t), with t from the drive's start
};

/// Mean and fundamental of theta from a run of one period, or of half a period if symmetric. `M_wave` is the
/// fundamental of M. Requires is_linear_but_for_friction(); none if friction nearly cancels M.
std::optional<Fundamental> by_friction(const SteadyQuestion& question, const SteadyMotion& motion,
                                       const motion::Run& run, std::complex<double> M_wave);

/// Returns whether the system is linear except for Coulomb friction, so that by_friction() applies.
bool is_linear_but_for_friction(const SteadyQuestion& question);

}  // namespace dinal::analysis
