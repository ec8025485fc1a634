// Closed forms of the steady motion under M0 sin wt: without dry friction, and with friction as equivalent viscous
// damping.
//
// r = w/w0, zeta viscous, gamma = Rd/M0 the friction ratio; amplitudes in units of M0/k, lags in rad.
#pragma once

#include <optional>

#include "model/oscillator.hpp"

namespace dinal::theory {

/// 1 - r^2 without loss of digits near resonance.
inline double detuning(double r) {
    return (1 - r) * (1 + r);
}

/// Phi = 1/sqrt((1 - r^2)^2 + 4 zeta^2 r^2); infinity at r = 1 without damping.
double magnification(double r, double zeta);
/// The lag of the motion behind the load: atan2(2 zeta r, 1 - r^2), 0 to pi; pi/2 at r = 1 for any zeta.
double phase_lag(double r, double zeta);

/// Amplitude and lag of a harmonic motion, or of the fundamental of another motion.
struct Harmonic_motion {
    double amplitude = 0;
    double lag = 0;
};
/// The motion with friction replaced by equivalent damping, for small gamma. None from gamma = pi/4 on, where friction
/// would dissipate more than the load supplies.
std::optional<Harmonic_motion> linearised_friction(double r, double zeta, double friction_ratio);

}  // namespace dinal::theory
