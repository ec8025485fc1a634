// The stick/slip law, once for all integrators except that of 1989.
#pragma once

#include <cmath>
#include <limits>

#include "model/lowered.hpp"

namespace dinal::model {

/// side (M - k theta) - limit, exact to one rounding near the limit: M -+ limit is kept in two parts and the product is
/// fused.
inline double excess_over(double limit, double k, double M, double theta, double side) {
    const double m = side * M;
    const double sum = m - limit;
    const double part = sum - m;
    const double rest = (m - (sum - part)) - (limit + part);
    return std::fma(-k, side * theta, sum) + rest;
}

/// The excess of the torque at velocity zero over the holding limit, |M - k theta| - Re. M includes a nonlinear spring.
inline double breakaway_excess(const Lowered& system, double M, double theta) {
    const double k = system.stiffness();
    M -= system.spring(theta);
    const bool back = std::fma(-k, theta, M) < 0;
    return excess_over(system.holding(back ? Motion::backward : Motion::forward), k, M, theta, back ? -1 : 1);
}

/// Returns whether a mass stuck at theta stays there however M changes, as long as |M| <= most_M.
inline bool cannot_break_away(const Lowered& system, double most_M, double theta) {
    const double k_theta = system.pull_back(theta);
    return most_M - k_theta <= system.holding(Motion::forward) && most_M + k_theta <= system.holding(Motion::backward);
}

/// The motion that starts at velocity zero under the torque M: none if |M - k theta| <= Re, otherwise towards M - k
/// theta.
// NOTE: a stored theta stands for all angles within half a unit of its last place, so k theta is known to 2^-53 |k
// theta| only. A smaller excess is no breakaway; otherwise theta0 = Re/k would stick or not depending on the rounding
// of the quotient. M is taken as exact.
inline Motion motion_from_standstill(const Lowered& system, double M, double theta) {
    constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
    constexpr double few = 8;  // roundings in a user's formula
    const double excess = breakaway_excess(system, M, theta), own = system.spring(theta);
    if (!(excess > 0) || excess < half_ulp * (std::fabs(system.stiffness() * theta) + few * std::fabs(own))) {
        return Motion::stuck;
    }
    return motion_of(std::fma(-system.stiffness(), theta, M - own));
}

/// The friction torque on the mass: against the motion while moving, -(M - k theta) while stuck.
inline double friction_torque(const Lowered& system, Motion motion, double M, const State& state) {
    if (!system.dry()) return 0;
    if (motion == Motion::stuck) return std::fma(system.stiffness(), state.theta, system.spring(state.theta) - M);
    return 0.0 - (system.braking(motion) + system.friction_remainder(motion, state));  // 0 - x: never -0
}

}  // namespace dinal::model
