// The end of a stretch: the first event in it.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "motion/engine/signal.hpp"

namespace dinal::motion::engine {

/// Causes that end a stretch.
enum class By { nobody, slip, release, wall, stop, slider, corner, relay, user, kink, stays, condition };

struct Ending {
    double x = 1;  ///< point in the stretch, -1 to 1
    By by = By::nobody;
    std::size_t which = 0;  ///< index of the joint, or of the body of a relay
    /// which wall, corner or direction of release; for an elastic wall 0 means it is left; the relay's index
    int side = 0;
    std::vector<std::size_t> users = {};  ///< user events at this instant, in the order of their definition
    /// function and index of each condition that changes
    std::vector<std::pair<Piecewise*, std::size_t>> conditions = {};
    /// whether some margin at the start exceeds the rounding there, but not that over the stretch
    bool blurred = false;
    /// Returns the latest point for user events and conditions. Those very close to a standstill or release count as
    /// later.
    double before() const {
        constexpr double beside_standstill = 1e-12;
        const bool at_standstill = by == By::slip || by == By::release || by == By::stays;
        return x - (at_standstill ? beside_standstill : 0);
    }
};

/// Zeros closer than this count as simultaneous.
inline constexpr double one_instant = 64 * rounding;

}  // namespace dinal::motion::engine
