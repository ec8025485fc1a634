// The walls of a run, and the impulses along its joints.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// Reference points for accurate distances from walls. Does not change the motion.
struct Walls {
    explicit Walls(const model::System& system);

    bool any = false;
    /// for each joint: angle of the wall it hit last, and greatest distance from there since
    std::vector<double> origin, reach;
    /// for each joint: time of its last impact, and the number of successive bounces too low to resolve
    std::vector<double> impact;
    std::vector<int> low;
    std::pair<std::size_t, int> last_hit{0, 0};  ///< joint and side of the wall
    double instant = model::never, fastest = 0;  ///< time of the last impact, and the fastest one at about that time

    void struck(std::size_t joint, double place) { origin[joint] = place, reach[joint] = 0; }
    /// Updates the distances from the walls after the motion has advanced.
    void follow(const model::System& system, const Now& now);
    /// Clamps angles of bodies to their rigid walls.
    static void keep_within(const model::System& system, std::vector<double>& y);
};

/// Impulses along joints. They conserve momentum, and rigidly linked bodies take part.
class Impulses {
public:
    /// The effect of an impulse: for each body its velocity if the joint stopped, and its share of a relative velocity.
    struct Thrown {
        double lightness = 0;
        std::vector<std::pair<double, double>> velocities = {};
    };
    explicit Impulses(const Mechanics& mechanics) : mechanics_(mechanics) {}
    [[nodiscard]] Thrown along(std::size_t joint, const Now& now);
    /// Gives the joint this relative velocity after the impact.
    static void apply(const Thrown& thrown, double relative, Now& now);

private:
    const Mechanics& mechanics_;
    std::optional<Frame> rigid_;  ///< frame with only the rigid joints sticking
};

}  // namespace dinal::motion::engine
