// The magnitude of the torques in a run, as the scale of their rounding.
#pragma once

#include <cmath>
#include <vector>

#include "motion/engine/mechanics.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

/// The magnitude of the torques on each body, including the loads of the last stretch.
class TorqueSizes {
public:
    void find(const Mechanics& mechanics, const Segment& last, const Moment& at);
    /// Returns the magnitude of the torques on a joint's bodies, as torques on its angle.
    double on(const model::Joint& joint) const {
        double size = 0;
        for (const auto& [body, by] : joint.of) size += of_bodies_[body] / std::fabs(by);
        return size;
    }

    double on_body(std::size_t body) const { return of_bodies_[body]; }

private:
    void pass_on(const model::System& system);

    std::vector<double> of_bodies_;
};

}  // namespace dinal::motion::engine
