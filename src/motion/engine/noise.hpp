// The noise of torques and rates: the roughness that no shorter stretch resolves.
#pragma once

#include <algorithm>
#include <vector>

#include "motion/engine/mechanics.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

class Proofs;

/// Measures it, and remembers it for the run. It resolves nothing itself.
class Noise {
public:
    explicit Noise(const Mechanics& mechanics);

    /// Returns whether a stretch that was not resolved, nor a longer one before it, is as rough on far shorter
    /// stretches, at one place as at another. From then on it need not be smoother than that. `sizes`: of the torques
    /// on each body. `proofs` know the rounding of functions that are read.
    bool found(const Segment& segment, const Mode& mode, double tolerance, const std::vector<double>& sizes,
               Proofs& proofs);
    /// Notes what has acted on a stretch that was resolved.
    void pass(const Segment& segment);
    [[nodiscard]] const Floor& floor() const { return floor_; }
    /// Begins with what an earlier run of the same system has found.
    void know(const Floor& floor) {
        if (floor.noise.size() == floor_.noise.size()) floor_ = floor;
    }
    /// Returns that of the body where it is greatest, torque.
    [[nodiscard]] double of_torques() const { return floor_.noise_of_torques(mechanics_.bodies()); }
    /// The same, if it is more than the tolerance would allow beside what has acted.
    [[nodiscard]] double clear(double tolerance) const;

private:
    /// Returns the torques on a body, or the rate of a state.
    [[nodiscard]] const Nodes& acting(const Segment& segment, std::size_t of) const {
        const std::size_t n = mechanics_.bodies();
        return of < n ? segment.torques[of] : segment.f[n + of];
    }
    struct Stalled {
        double from = -model::never, h = 0, tail = 0;
    };

    const Mechanics& mechanics_;
    Floor floor_;
    std::vector<Stalled> stalled_;    ///< of each body and state: the last stretch that it made too long
    std::vector<char> may_be_rough_;  ///< of the same: a function acts
};

}  // namespace dinal::motion::engine
