#include "motion/engine/walls.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

Walls::Walls(const model::System& system)
    : origin(system.joints.size(), 0),
      reach(system.joints.size(), 0),
      impact(system.joints.size(), -model::never),
      low(system.joints.size(), 0) {
    for (const model::Joint& joint : system.joints) any |= joint.any_walls() != nullptr;
}

void Walls::follow(const model::System& system, const Now& now) {
    for (std::size_t j = 0; any && j < reach.size(); ++j) {
        const model::Joint& joint = system.joints[j];
        if (joint.any_walls() != nullptr) reach[j] = std::max(reach[j], std::fabs(now.gap(joint, origin[j])));
    }
}

void Walls::keep_within(const model::System& system, std::vector<double>& y) {
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (const auto& walls = system.joints[i].walls) y[i] = std::clamp(y[i], walls->lower, walls->upper);
    }
}

Impulses::Thrown Impulses::along(std::size_t joint, const Now& now) {
    const std::size_t n = mechanics_.bodies();
    if (!rigid_) {
        Mode free = now.mode;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) free.leans[j] = 0, free.rubs[j] = 0;
        rigid_.emplace(mechanics_.system(), free);
    }
    Thrown thrown;
    for (const auto& [group, by] : rigid_->joints[joint]) thrown.lightness += by * by / rigid_->inertia[group];
    const double speed = mechanics_.velocity(joint, now.y);
    for (std::size_t i = 0; i < n; ++i) {
        double share = 0;
        for (const auto& [group, by] : rigid_->bodies[i]) {
            for (const auto& [own_group, turned] : rigid_->joints[joint]) {
                if (own_group == group) share += by * turned / rigid_->inertia[group] / thrown.lightness;
            }
        }
        thrown.velocities.emplace_back(now.y[n + i] - share * speed, share);
    }
    return thrown;
}

void Impulses::apply(const Thrown& thrown, double relative, Now& now) {
    const std::size_t n = thrown.velocities.size();
    for (std::size_t i = 0; i < n; ++i) {
        const auto& [still, share] = thrown.velocities[i];
        if (share != 0) now.y[n + i] = still + share * relative;
    }
}

}  // namespace dinal::motion::engine
