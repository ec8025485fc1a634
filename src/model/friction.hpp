// The stick/slip law, once, for every integrator but the museum piece of 1989.
#pragma once

#include <cmath>
#include <limits>

#include "model/oscillator.hpp"

namespace dinal::model {

/// Which way the mass moves. `stuck` is exact: velocity 0, theta constant.
enum class Motion : int { backward = -1, stuck = 0, forward = 1 };

constexpr double sign_of(Motion motion) {
    return static_cast<double>(static_cast<int>(motion));
}

inline Motion motion_of(double velocity) {
    return velocity > 0 ? Motion::forward : velocity < 0 ? Motion::backward : Motion::stuck;
}

/// How far the torque on a mass at velocity zero is past what sticking can hold: |M - k theta| - Re.
/// The limit is a razor's edge, so M -+ Re is kept in two parts and the product is fused: what is left near the limit
/// is the exact difference, rounded once.
inline double breakaway_excess(const Oscillator& system, double M, double theta) {
    const double k = system.stiffness();
    const double side = std::fma(-k, theta, M) < 0 ? -1 : 1;
    const double m = side * M;
    const double sum = m - system.breakaway();
    const double part = sum - m;
    const double rest = (m - (sum - part)) - (system.breakaway() + part);
    return std::fma(-k, side * theta, sum) + rest;
}

/// What a mass at velocity zero does under the torque M: stay (|M - k theta| <= Re), or move off towards M - k theta.
// NOTE: a stored theta stands for all angles within half a unit of its last place. So k theta is known to within
// 2^-53 |k theta| only, and an excess below that is no breakaway; otherwise theta0 = Re/k would stick or not
// depending on how the quotient was rounded. M itself is taken to the letter.
inline Motion motion_from_standstill(const Oscillator& system, double M, double theta) {
    constexpr double half_ulp = std::numeric_limits<double>::epsilon() / 2;
    const double excess = breakaway_excess(system, M, theta);
    if (!(excess > 0) || excess < half_ulp * std::fabs(system.stiffness() * theta)) {
        return Motion::stuck;
    }
    return motion_of(std::fma(-system.stiffness(), theta, M));
}

/// The true friction torque on the mass: -Rd sgn(velocity) while moving, -(M - k theta) while stuck.
inline double friction_torque(const Oscillator& system, Motion motion, double M, double theta) {
    return motion == Motion::stuck ? std::fma(system.stiffness(), theta, -M)
                                   : 0.0 - system.kinetic_friction() * sign_of(motion);  // 0 - x: never -0
}

}  // namespace dinal::model
