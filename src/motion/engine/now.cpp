#include "motion/engine/now.hpp"

#include <limits>
#include <utility>

namespace dinal::motion::engine {

using model::Motion;

double Now::greatest_of_state() const {
    double most = 0;
    for (const double value : y) most = std::max(most, std::fabs(value));
    return most;
}

const std::vector<double>& Now::departing(const model::System& system, std::vector<double>& made) const {
    bool any = false;
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        if (!mode.friction[j].leaving || mode.leans[j] != 0) continue;
        if (!std::exchange(any, true)) made = y;
        const model::Weight& first = system.joints[j].of.front();
        double& v = made[system.bodies.size() + first.body];
        if (v == 0)
            v = std::copysign(std::numeric_limits<double>::min(), model::sign_of(mode.friction[j].way) * first.by);
    }
    return any ? made : y;
}

double Now::belt_heading(const Mechanics& mechanics, std::size_t joint) const {
    const double v = mechanics.belt(joint, t.hi, side());
    if (v != 0 || !mechanics.has_belt(joint)) return v;
    const double rate = belt_slopes[joint].sure();
    return rate == 0 ? 0 : std::copysign(std::numeric_limits<double>::min(), rate);
}

bool Now::belt_sets_off(const Mechanics& mechanics, std::size_t joint) const {
    const double v = mechanics.belt(joint, t.hi, side());
    return std::fabs(v) <= 16 * rounding * std::fabs(t.hi * belt_slopes[joint].rate);
}

void Now::keep_rigid_places(const model::System& system) {
    for (std::size_t j = 0; j < rigid_at.size(); ++j) {
        if (mode.rigid[j] != 0) rigid_at[j] = system.joints[j].sum(y) + system.joints[j].sum(low);
    }
}

void Now::put_child(const model::Joint& joint, std::size_t child, double weight, double place) {
    double rest = 0;
    for (const auto& [body, by] : joint.of) {
        if (body != child) place -= by * y[body], rest -= by * low[body];
    }
    y[child] = place / weight, low[child] = rest / weight;
}

}  // namespace dinal::motion::engine
