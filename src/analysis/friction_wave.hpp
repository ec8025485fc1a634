// The mean and the fundamental of a steady motion of a linear system by what its friction does: as k theta + C theta' +
// I theta'' is M less the friction, these two follow from the same integrals of M and of the friction, which is a
// constant while the mass slides, and M - k theta while it stands. No motion between the events is asked for.
#pragma once

#include <complex>
#include <optional>

#include "analysis/steady.hpp"

namespace dinal::analysis {

struct Fundamental {
    double mean = 0;            ///< of theta
    std::complex<double> wave;  ///< (2/T) times the integral of theta e^(-i omega t), counted from the drive's start
};

/// From a run of half a period of a symmetric motion, or of all of it. `M_wave` is the fundamental of M. None where the
/// system is another one, and where friction and M nearly cancel, as near resonance.
std::optional<Fundamental> by_friction(const SteadyQuestion& question, const SteadyMotion& motion,
                                       const motion::Trajectory& run, std::complex<double> M_wave);

/// It is a system that this can take: the run may do without the motion between its events.
bool is_linear_but_for_friction(const SteadyQuestion& question);

}  // namespace dinal::analysis
