// Limits of the step for numerical methods: what the report printed, what its argument really gives, what is true.
#pragma once

#include "model/oscillator.hpp"

namespace dinal::theory {

/// deltatmax as the program of 1989 printed it: T0 (zeta + gamma/VMAX), VMAX = sqrt((w0 theta0)^2 + velocity0^2) and
/// gamma = Rd/|Mc|. Its second term depends on the units. Infinity with friction and nothing that moves.
double printed_step_limit(const model::Oscillator& system, const model::State& initial, double characteristic_torque);

/// The argument of the report without its slips: Euler's amplification matrix asks for h < (a + K b)/c, that is
/// T0 zeta/pi + Rd/(k VMAX), whatever Mc is. It is no limit of Runge-Kutta: see rk4::stability_limit in motion/rk4.
double euler_step_limit(const model::Oscillator& system, const model::State& initial);

}  // namespace dinal::theory
