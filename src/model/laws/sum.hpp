// Laws in parallel on one contact: one of any kind, and constant torques.
#pragma once

#include <array>

#include "model/friction.hpp"

namespace dinal::model::laws {

template <bool speed>
struct Sum {
    Friction main;
    std::array<double, 2> more_sliding{}, more_holding{};  ///< backward and forward

    static constexpr bool depends_on_speed = speed;
    [[nodiscard]] static std::size_t side(Motion way) { return way == Motion::forward ? 1 : 0; }
    [[nodiscard]] double sliding(Motion way, double at) const {
        return main.sliding(way, at) + more_sliding[side(way)];
    }
    [[nodiscard]] double holding(Motion way) const { return main.holding(way) + more_holding[side(way)]; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return main.complaint(); }
    [[nodiscard]] std::size_t ranges() const { return more_sliding[0] == more_sliding[1] ? main.ranges() : 0; }
    [[nodiscard]] SpeedRange range(std::size_t i) const {
        SpeedRange range = main.range(i);
        range.torque += more_sliding[0];
        return range;
    }
    [[nodiscard]] double slope(double at) const { return main.slope(at); }
    [[nodiscard]] double scale(double at) const { return main.scale(at); }
};

}  // namespace dinal::model::laws
