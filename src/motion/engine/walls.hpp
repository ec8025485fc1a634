// The walls of a run, and the impulses along its joints.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "motion/engine/now.hpp"

namespace dinal::motion::engine {

/// The places from which motions near walls are known best. It moves nothing.
struct Walls {
    explicit Walls(const model::System& system);

    bool any = false;
    std::vector<double> origin, reach;  ///< of each joint: the wall that it hit last, and how far it went from there
    std::pair<std::size_t, int> last_hit{0, 0};  ///< the joint and its wall

    void struck(std::size_t joint, double place) { origin[joint] = place, reach[joint] = 0; }
    /// The motion has gone on: joints may have got farther from the wall that they hit last.
    void follow(const model::System& system, const Now& now);
    /// Keeps angles of bodies between their rigid walls.
    static void keep_within(const model::System& system, std::vector<double>& y);
};

/// Impulses along joints: they conserve momentum, and what is linked rigidly takes its part.
class Impulses {
public:
    /// For each body, its velocity if the joint turned no more, and its share of a relative velocity.
    struct Thrown {
        double lightness = 0;
        std::vector<std::pair<double, double>> velocities = {};
    };
    explicit Impulses(const Mechanics& mechanics) : mechanics_(mechanics) {}
    [[nodiscard]] Thrown along(std::size_t joint, const Now& now);
    /// Gives the joint this relative velocity.
    static void apply(const Thrown& thrown, double relative, Now& now);

private:
    const Mechanics& mechanics_;
    std::optional<Frame> rigid_;  ///< what moves where nothing but rigid joints hold
};

}  // namespace dinal::motion::engine
