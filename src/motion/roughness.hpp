// How rough a function is at a time: noise is as rough on every scale, and ends a run that gets nowhere.
#pragma once

#include <array>
#include <functional>

namespace dinal::motion {

/// Of three short stretches: how great the last coefficients are at most, and on two of them, and the values.
struct Roughness {
    double most = 0, usual = 0, size = 0;

    /// What is as rough on two stretches is no jump.
    [[nodiscard]] bool is_noise() const {
        constexpr double alike = 0.1;
        return usual > alike * most;
    }
};

/// Noise is at most this part of the torques; the steps of what is rougher are located.
inline constexpr double most_noise = 1e-5;
/// The same part of M where it depends on the motion: steps greater than those of single precision are located.
inline constexpr double most_noise_of_motion = 1.2e-7;

/// A stretch is this part of the time scale of a motion.
inline constexpr double rough_stretch = 1e-3;

/// On stretches of this length that begin at these times. Nothing where the function has a value that is no number.
[[nodiscard]] Roughness roughness(const std::function<double(double)>& function, const std::array<double, 3>& starts,
                                  double length);

}  // namespace dinal::motion
