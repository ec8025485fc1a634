// How fast a belt changes its velocity, which carries or throws off a mass that is stuck to it.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/excitation.hpp"

namespace dinal::motion {

struct BeltSlope {
    double rate, doubt;  ///< in velocities per time unit; what of it may be rounding, or the belt's own noise
    /// Nearer to zero by the doubt.
    [[nodiscard]] double sure() const { return std::copysign(std::max(0.0, std::fabs(rate) - doubt), rate); }
};

/// Part of the time scale of a motion: the stretch in which a belt may be differentiated.
inline constexpr double belt_stretch = 0.05;

/// The velocity at t, from the right where it is known to break.
[[nodiscard]] double belt_from(const model::Excitation& belt, double t);

/// From the right, by the derivative of a polynomial through `stretch`, or less where that is not smooth: right to some
/// twelve digits.
[[nodiscard]] BeltSlope belt_slope(const model::Excitation& belt, double t, double stretch);

}  // namespace dinal::motion
