#include "motion/engine/torque_sizes.hpp"

#include <algorithm>

namespace dinal::motion::engine {

void TorqueSizes::find(const Mechanics& mechanics, const Segment& last, const Moment& at) {
    of_bodies_.assign(mechanics.bodies(), 0);
    for (std::size_t j = 0; j < mechanics.joints(); ++j) {
        double load = last.loads.empty() ? 0 : greatest(last.loads[j]);
        // A load that depends on the motion may be 0 now but not slightly later.
        if (!last.loads.empty() && mechanics.loads()[j].asks_the_motion()) {
            load = std::max(load, greatest(last.driven[j]));
        }
        const double size = load + mechanics.size_of(j, at);
        for (const auto& [body, by] : mechanics.system().joints[j].of) of_bodies_[body] += std::fabs(by) * size;
    }
}

}  // namespace dinal::motion::engine
