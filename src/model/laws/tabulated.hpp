// Measured friction: straight lines between torques at given speeds, alike in both directions.
#pragma once

#include <algorithm>
#include <vector>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

struct Tabulated {
    std::vector<double> speed;          ///< increasing from 0
    std::vector<double> torque;         ///< one for each speed; the last holds at all greater speeds
    std::optional<double> breakaway{};  ///< Re; by default the first torque

    static constexpr bool depends_on_speed = true;
    double sliding(Motion /*way*/, double v) const {
        if (v >= speed.back()) return torque.back();
        const auto above = std::upper_bound(speed.begin() + 1, speed.end(), v);  // the first line extends below 0
        return range(static_cast<std::size_t>(above - speed.begin()) - 1).at(v);
    }
    double holding(Motion /*way*/) const { return breakaway.value_or(torque.front()); }
    /// 0 if the slope of a line overflows.
    std::size_t ranges() const;
    SpeedRange range(std::size_t i) const {
        SpeedRange line{.from = speed[i], .straight = true, .torque = torque[i]};
        if (i + 1 == speed.size()) return line;
        line.to = speed[i + 1];
        line.slope = (torque[i + 1] - torque[i]) / (speed[i + 1] - speed[i]);
        return line;
    }
    [[nodiscard]] std::optional<text::Error> complaint() const;
    std::string lua_text() const;
};

inline constexpr text::Option tabulated_options[] = {
    {"speed", "rad per time unit", text::needed, text::any_finite, "increasing from 0", text::fills<&Tabulated::speed>},
    {"torque", "torque", text::needed, text::any_finite,
     "the friction at each speed; the last value holds for greater speeds", text::fills<&Tabulated::torque>},
    {"Re", "torque", "the first torque", text::not_negative, "breakaway torque, at least the first torque",
     text::fills<&Tabulated::breakaway>},
};
inline constexpr text::Call tabulated_call{
    "friction.table", "friction.table{ speed = { 0, 0.1, 1 }, torque = { 0.5, 0.3, 0.35 } }", tabulated_options};

}  // namespace dinal::model::laws
