// The acceleration of a belt, which carries or throws off a mass stuck to it.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/excitation.hpp"

namespace dinal::motion {

struct BeltSlope {
    double rate, doubt;  ///< velocity per time unit; `doubt` is its error from rounding or the belt's own noise
    /// The rate moved towards zero by its error.
    double sure() const { return std::copysign(std::max(0.0, std::fabs(rate) - doubt), rate); }
};

/// The interval over which a belt is differentiated, as a fraction of the motion's time scale.
inline constexpr double belt_stretch = 0.05;

/// The belt's velocity at t; at a known break the limit from the right.
[[nodiscard]] double belt_from(const model::Excitation& belt, double t);

/// The right-hand slope at t from a polynomial through `stretch` time units, or fewer if the belt is not smooth there.
/// The relative error is about 1e-12.
[[nodiscard]] BeltSlope belt_slope(const model::Excitation& belt, double t, double stretch);

}  // namespace dinal::motion
