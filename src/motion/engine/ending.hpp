// The end of a stretch: the first thing that happens in it.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "motion/engine/signal.hpp"

namespace dinal::motion::engine {

/// The kinds of what ends a stretch.
enum class By { nobody, slip, release, wall, stop, slider, corner, relay, user, kink, stays, condition };

struct Ending {
    double x = 1;  ///< the place in the stretch
    By by = By::nobody;
    std::size_t which = 0;  ///< the joint, or the body of a relay
    int side = 0;           ///< of a wall, a stop (0: it is left) or a corner, or the way of a release; or which relay
    std::vector<std::size_t> users = {};  ///< events of the user at this instant, in the order written
    std::vector<std::pair<Piecewise*, std::size_t>> conditions = {};  ///< of functions that were read
    bool blurred = false;  ///< one of them is clear of zero at the beginning, but for what rounds in the stretch
    /// Events of the user and conditions that pass zero so near to a standstill or a release come after it.
    [[nodiscard]] double before() const {
        constexpr double beside_standstill = 1e-12;
        const bool at_standstill = by == By::slip || by == By::release || by == By::stays;
        return x - (at_standstill ? beside_standstill : 0);
    }
};

/// Passages that are so near to each other are one.
inline constexpr double one_instant = 64 * rounding;

}  // namespace dinal::motion::engine
