// The noise of torques and rates: roughness that shorter stretches do not resolve.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "motion/engine/mechanics.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

/// Roughness on three short intervals: the greatest and the second greatest Chebyshev tail, and the greatest value.
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

class Proofs;

/// Measures noise and remembers it.
class Noise {
public:
    explicit Noise(const Mechanics& mechanics);

    /// Returns whether an unresolved stretch, like the longer one tried before it, is equally rough on much shorter
    /// intervals everywhere. This roughness is tolerated from then on. `sizes` are the torques on each body; `proofs`
    /// gives the rounding of formulas.
    bool found(const Segment& segment, const Mode& mode, double tolerance, const std::vector<double>& sizes,
               Proofs& proofs);
    /// Notes the greatest values of a resolved stretch, and forgets noise that a much longer one does not show.
    void note_resolved(const Segment& segment);
    [[nodiscard]] const Floor& floor() const { return floor_; }
    /// Starts with the noise found by an earlier run of the same system.
    void start_with(const Floor& floor) {
        if (floor.noise.size() == floor_.noise.size()) floor_ = floor;
    }
    /// Returns the noise of the torque on the noisiest body.
    [[nodiscard]] double of_torques() const { return floor_.noise_of_torques(mechanics_.bodies()); }
    /// Returns the greatest noise that was tolerated at any time if it exceeds the tolerance relative to the greatest
    /// torque; otherwise 0.
    [[nodiscard]] double notable(double tolerance) const;

private:
    /// Returns the torques on a body, or the rates of a state.
    [[nodiscard]] const Nodes& acting(const Segment& segment, std::size_t of) const {
        const std::size_t n = mechanics_.bodies();
        return of < n ? segment.torques[of] : segment.f[n + of];
    }
    /// The arguments of found().
    struct Unresolved {
        const Segment& segment;
        const Mode& mode;
        double tolerance;
        const std::vector<double>& sizes;
        Proofs& proofs;
    };
    [[nodiscard]] double value(std::size_t of, bool of_time, const Unresolved& stretch, double t) const;
    [[nodiscard]] std::optional<double> measured(std::size_t i, const Unresolved& stretch, std::vector<double>& known);
    struct Stalled {
        double from = -model::never, h = 0, tail = 0;
    };

    const Mechanics& mechanics_;
    Floor floor_;
    std::vector<Stalled> stalled_;    ///< for each body and state: the last stretch that it made unresolved
    std::vector<double> tolerated_;   ///< for each body and state: the greatest noise of the run
    std::vector<double> found_on_;    ///< half length of the stretch on which the noise was found
    std::vector<char> may_be_rough_;  ///< for each body and state: whether a function acts on it
};

}  // namespace dinal::motion::engine
