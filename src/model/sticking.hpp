// The stick/slip law, once, for every integrator but the museum piece of 1989.
#pragma once

#include <cmath>
#include <limits>

#include "model/lowered.hpp"

namespace dinal::model {

/// side (M - k theta) - limit, where the limit is a razor's edge: M -+ limit is kept in two parts and the product is
/// fused, so what is left near the limit is the exact difference, rounded once.
inline double excess_over(double limit, double k, double M, double theta, double side) {
    const double m = side * M;
    const double sum = m - limit;
    const double part = sum - m;
    const double rest = (m - (sum - part)) - (limit + part);
    return std::fma(-k, side * theta, sum) + rest;
}

/// How far the torque on a mass at velocity zero is past what sticking can hold: |M - k theta| - Re. A spring of its
/// own is part of M here.
inline double breakaway_excess(const Lowered& system, double M, double theta) {
    const double k = system.stiffness();
    M -= system.spring(theta);
    const bool back = std::fma(-k, theta, M) < 0;
    return excess_over(system.holding(back ? Motion::backward : Motion::forward), k, M, theta, back ? -1 : 1);
}

/// However M changes while |M| is at most this, it cannot move a mass that is stuck there.
inline bool held_against(const Lowered& system, double most_M, double theta) {
    const double k_theta = system.pull_back(theta);
    return most_M - k_theta <= system.holding(Motion::forward) && most_M + k_theta <= system.holding(Motion::backward);
}

/// What a mass at velocity zero does under the torque M: stay (|M - k theta| <= Re), or move off towards M - k theta.
// NOTE: a stored theta stands for all angles within half a unit of its last place. So k theta is known to within
// 2^-53 |k theta| only, and an excess below that is no breakaway; otherwise theta0 = Re/k would stick or not
// depending on how the quotient was rounded. M itself is taken to the letter.
inline Motion motion_from_standstill(const Lowered& system, double M, double theta) {
    constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
    constexpr double few = 8;  // roundings that a formula of the user makes
    const double excess = breakaway_excess(system, M, theta), own = system.spring(theta);
    if (!(excess > 0) || excess < half_ulp * (std::fabs(system.stiffness() * theta) + few * std::fabs(own))) {
        return Motion::stuck;
    }
    return motion_of(std::fma(-system.stiffness(), theta, M - own));
}

/// The true friction torque on the mass: against its motion while moving, -(M - k theta) while stuck.
inline double friction_torque(const Lowered& system, Motion motion, double M, const State& state) {
    if (!system.dry()) return 0;
    if (motion == Motion::stuck) return std::fma(system.stiffness(), state.theta, system.spring(state.theta) - M);
    return 0.0 - (system.braking(motion) + system.friction_remainder(motion, state));  // 0 - x: never -0
}

}  // namespace dinal::model
