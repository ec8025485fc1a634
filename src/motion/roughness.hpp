// The roughness of a function at a time: noise is equally rough on every scale, and prevents a run from advancing.
#pragma once

#include <array>
#include <functional>

namespace dinal::motion {

/// From three short stretches: the greatest and the second greatest of the last Chebyshev coefficients, and of the
/// values.
struct Roughness {
    double most = 0, usual = 0, size = 0;

    /// A jump would be rough on one stretch only.
    [[nodiscard]] bool is_noise() const {
        constexpr double alike = 0.1;
        return usual > alike * most;
    }
};

/// The limit of noise as a part of the torques; steps of rougher functions are located instead.
inline constexpr double most_noise = 1e-5;
/// The same for an M that depends on the motion; it admits single precision.
inline constexpr double most_noise_of_motion = 1.2e-7;

/// The length of a stretch as a part of the motion's time scale.
inline constexpr double rough_stretch = 1e-3;

/// Evaluates stretches of this length from each start. All zero if a value is not finite.
[[nodiscard]] Roughness roughness(const std::function<double(double)>& function, const std::array<double, 3>& starts,
                                  double length);

}  // namespace dinal::motion
