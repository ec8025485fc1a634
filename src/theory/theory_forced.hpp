// Closed forms of the steady motion under M0 sin wt: without dry friction, and with dry friction taken for viscous.
//
// r = w/w0, zeta viscous, gamma = Rd/M0 the friction ratio; amplitudes in units of M0/k, lags in rad.
#pragma once

#include <optional>

#include "model/oscillator.hpp"

namespace dinal::theory {

/// 1 - r^2, without loss of digits near resonance.
inline double detuning(double r) {
    return (1 - r) * (1 + r);
}

/// Phi = 1/sqrt((1 - r^2)^2 + 4 zeta^2 r^2); infinity at r = 1 without damping.
double magnification(double r, double zeta);
/// How far the motion is behind the load: atan2(2 zeta r, 1 - r^2), 0 to pi; pi/2 at r = 1, whatever zeta.
double phase_lag(double r, double zeta);
/// Torque on the support over torque of the load, and motion of the mass over motion of its support.
double transmissibility(double r, double zeta);

/// The damping constant that takes as much energy from each cycle of amplitude X as friction: 4 Rd/(pi w X).
double equivalent_damping(double kinetic_friction, double omega, double amplitude);
/// The same as a damping ratio, for the amplitude Phi in units of M0/k: 2 gamma/(pi r Phi).
double equivalent_damping_ratio(double friction_ratio, double r, double magnification);
/// 4 Rd X: what friction takes from the energy in each cycle of amplitude X without stops.
double friction_work(double kinetic_friction, double amplitude);

/// Amplitude and lag of a harmonic motion, or of the fundamental of another one.
struct Harmonic_motion {
    double amplitude = 0;
    double lag = 0;
};
/// The motion with friction replaced by its equivalent damping: for small gamma. None from gamma = pi/4 on, where the
/// load would do less work than friction.
std::optional<Harmonic_motion> linearised_friction(double r, double zeta, double friction_ratio);

/// What the amplitude gains in a period at r = 1 without viscous damping, in M0/k: pi - 4 gamma, and 0 from
/// gamma = pi/4 on, where it does not grow.
double growth_at_resonance(double friction_ratio);

}  // namespace dinal::theory
