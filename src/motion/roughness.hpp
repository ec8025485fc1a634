// The roughness of a function at a time: noise is equally rough on every scale, and prevents a run from advancing.
#pragma once

#include <array>
#include <functional>

namespace dinal::motion {

/// Taken from three short intervals: the greatest and the second greatest Chebyshev tail, and the greatest value.
struct Roughness {
    double most = 0, usual = 0, size = 0;

    /// Returns whether at least two intervals are rough; a jump would make only one rough.
    bool is_noise() const {
        constexpr double alike = 0.1;
        return usual > alike * most;
    }
};

/// The limit of noise relative to the torques; rougher functions are treated as jumping.
inline constexpr double most_noise = 1e-5;
/// The limit for an M that depends on the motion; it admits single precision.
inline constexpr double most_noise_of_motion = 1.2e-7;

/// The length of an interval as a fraction of the motion's time scale.
inline constexpr double rough_stretch = 1e-3;

/// Samples `function` on intervals of this length from each start. All zero if a value is not finite.
[[nodiscard]] Roughness roughness(const std::function<double(double)>& function, const std::array<double, 3>& starts,
                                  double length);

}  // namespace dinal::motion
