// The noise of torques and rates: roughness that shorter stretches do not resolve.
#pragma once

#include <algorithm>
#include <vector>

#include "motion/engine/mechanics.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

class Proofs;

/// Measures noise and remembers it for the rest of the run.
class Noise {
public:
    explicit Noise(const Mechanics& mechanics);

    /// Returns whether an unresolved stretch, like the longer one tried before it, is equally rough on much shorter
    /// intervals everywhere. This roughness is tolerated from then on. `sizes` are the torques on each body; `proofs`
    /// gives the rounding of formulas.
    bool found(const Segment& segment, const Mode& mode, double tolerance, const std::vector<double>& sizes,
               Proofs& proofs);
    /// Notes the greatest values of a resolved stretch.
    void pass(const Segment& segment);
    [[nodiscard]] const Floor& floor() const { return floor_; }
    /// Starts with the noise found by an earlier run of the same system.
    void know(const Floor& floor) {
        if (floor.noise.size() == floor_.noise.size()) floor_ = floor;
    }
    /// Returns the noise of the noisiest body, torque.
    [[nodiscard]] double of_torques() const { return floor_.noise_of_torques(mechanics_.bodies()); }
    /// The same if it exceeds the tolerance relative to the greatest torque; otherwise 0.
    [[nodiscard]] double clear(double tolerance) const;

private:
    /// Returns the torques on a body, or the rates of a state.
    [[nodiscard]] const Nodes& acting(const Segment& segment, std::size_t of) const {
        const std::size_t n = mechanics_.bodies();
        return of < n ? segment.torques[of] : segment.f[n + of];
    }
    struct Stalled {
        double from = -model::never, h = 0, tail = 0;
    };

    const Mechanics& mechanics_;
    Floor floor_;
    std::vector<Stalled> stalled_;    ///< for each body and state: the last stretch that it made unresolved
    std::vector<char> may_be_rough_;  ///< for each body and state: whether a function acts on it
};

}  // namespace dinal::motion::engine
