// An embedded pair of explicit Runge-Kutta methods with dense output, as numbers: what the general engine steps by.
#pragma once

#include <array>
#include <span>

namespace dinal::motion {

struct Pair {
    static constexpr std::size_t most_stages = 7;
    using Weights = std::array<double, most_stages>;
    struct Stage {
        double at;    ///< which part of the step
        Weights sum;  ///< of the slopes at the stages before
    };
    double power;                   ///< the estimated error grows like this power of the step
    std::span<const Stage> stages;  ///< behind the one at the start; the last one is the end of the step
    Weights error;                  ///< of the slopes in this estimate, by the step
    /// Within the step, at its part x, the motion is the cubic through values and slopes at both ends, and x^2 (1 -
    /// x)^2 times this sum of the slopes, by the step.
    Weights bulge;
};

}  // namespace dinal::motion
