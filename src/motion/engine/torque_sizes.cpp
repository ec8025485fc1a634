#include "motion/engine/torque_sizes.hpp"

#include <algorithm>

namespace dinal::motion::engine {

void TorqueSizes::find(const Mechanics& mechanics, const Segment& last, const Moment& at) {
    of_bodies_.assign(mechanics.bodies(), 0);
    for (std::size_t j = 0; j < mechanics.joints(); ++j) {
        double load = last.loads.empty() ? 0 : greatest(last.loads[j]);
        // A load that depends on the motion may be 0 now but not slightly later.
        if (!last.loads.empty() && mechanics.loads()[j].depends_on_motion()) {
            load = std::max(load, greatest(last.driven[j]));
        }
        const double size = load + mechanics.size_of(j, at);
        for (const auto& [body, by] : mechanics.system().joints[j].of) of_bodies_[body] += std::fabs(by) * size;
    }
    pass_on(mechanics.system());
}

/// A gear or freewheel can transmit the torques of one of its bodies to the others.
void TorqueSizes::pass_on(const model::System& system) {
    // One pass per joint is enough for a chain in any order.
    for (std::size_t pass = 0; pass < system.joints.size(); ++pass) {
        bool grown = false;
        for (const model::Joint& joint : system.joints) {
            if (joint.of.size() < 2 || !(joint.rigid || joint.friction.law.is_one_way())) continue;
            double size = 0;
            for (const auto& [body, by] : joint.of) size = std::max(size, of_bodies_[body] / std::fabs(by));
            for (const auto& [body, by] : joint.of) {
                grown = grown || of_bodies_[body] < std::fabs(by) * size;
                of_bodies_[body] = std::max(of_bodies_[body], std::fabs(by) * size);
            }
        }
        if (!grown) return;
    }
}

}  // namespace dinal::motion::engine
