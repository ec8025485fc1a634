// Stribeck's law, as a stranger to the program would add it: friction falls from Re at rest towards Rd with the speed.
#pragma once

#include <cmath>

#include "model/friction.hpp"

namespace dinal::truth {

struct Stribeck {
    double kinetic = 0;    ///< Rd, at great speeds
    double breakaway = 0;  ///< Re
    double speed = 1;      ///< at which the difference has fallen to 1/e

    static constexpr bool depends_on_speed = true;
    [[nodiscard]] double sliding(model::Motion /*way*/, double v) const {
        return kinetic + (breakaway - kinetic) * std::exp(-(v / speed) * (v / speed));
    }
    [[nodiscard]] double holding(model::Motion /*way*/) const { return breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        return model::wrong_torques("stribeck.", kinetic, breakaway);
    }
};

}  // namespace dinal::truth
