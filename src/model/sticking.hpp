// The stick/slip law, once for all integrators except that of 1989.
#pragma once

#include <algorithm>
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

/// The torque that pulls at a stuck mass. The mass breaks away if `beyond` is positive.
struct Pull {
    double beyond;   ///< excess of the pull over the limit
    Motion towards;  ///< the side to which it pulls
};

/// The pull of M, a spring k theta and the torque `spring` of a nonlinear one, against the breakaway limit on this
/// side. NOTE: a stored theta stands for all angles within half a unit of its last place, so k theta is known to 2^-53
/// |k theta| only. A smaller excess is no breakaway; otherwise theta0 = Re/k would stick or not depending on the
/// rounding of the quotient. M is taken as exact.
inline Pull pull_on_spring(double limit, double k, double M, double theta, double spring, Motion towards) {
    constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
    constexpr double few = 8;  // roundings in a user's formula
    const double beyond = excess_over(limit, k, M - spring, theta, sign_of(towards));
    const double known = half_ulp * (std::fabs(k * theta) + few * std::fabs(spring));
    return {beyond < known ? std::min(beyond, 0.0) : beyond, towards};
}

/// The pull on a mass stuck at theta.
inline Pull pull_at_rest(const Lowered& system, double M, double theta) {
    const double k = system.stiffness(), spring = system.spring(theta);
    const Motion towards = std::fma(-k, theta, M - spring) < 0 ? Motion::backward : Motion::forward;
    return pull_on_spring(system.holding(towards), k, M, theta, spring, towards);
}

/// Returns whether a mass stuck at theta stays there however M changes, as long as |M| <= most_M.
inline bool cannot_break_away(const Lowered& system, double most_M, double theta) {
    const double k_theta = system.pull_back(theta);
    return most_M - k_theta <= system.holding(Motion::forward) && most_M + k_theta <= system.holding(Motion::backward);
}

/// The motion that starts at velocity zero under the torque M: `stuck` if |M - k theta| <= Re, otherwise towards M - k
/// theta.
inline Motion motion_from_standstill(const Lowered& system, double M, double theta) {
    const Pull pull = pull_at_rest(system, M, theta);
    return pull.beyond > 0 ? pull.towards : Motion::stuck;
}

/// The friction torque on the mass: against the motion while moving, -(M - k theta) while stuck. Where M jumps clearly
/// beyond Re at the end of a run, the mass moves from there on.
inline double friction_torque(const Lowered& system, Motion motion, double M, const State& state) {
    if (!system.dry()) return 0;
    if (motion == Motion::stuck) {
        constexpr double clearly = 1e-9;
        const double pull_back = system.pull_back(state.theta);
        const Pull pull = pull_at_rest(system, M, state.theta);
        if (!(pull.beyond > clearly * (std::fabs(M) + std::fabs(pull_back))))
            return std::fma(system.stiffness(), state.theta, system.spring(state.theta) - M);
        motion = pull.towards;
    }
    return 0.0 - (system.braking(motion) + system.friction_remainder(motion, state));  // 0 - x: never -0
}

}  // namespace dinal::model
