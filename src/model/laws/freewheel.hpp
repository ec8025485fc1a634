// A one-way clutch: it turns forward against Rd and holds any torque backward.
#pragma once

#include <fmt/format.h>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

struct Freewheel {
    double kinetic = 0;  ///< Rd, also the breakaway torque forward

    static constexpr bool depends_on_speed = false;
    [[nodiscard]] double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    [[nodiscard]] double holding(Motion way) const {
        return way == Motion::backward ? std::numeric_limits<double>::infinity() : kinetic;
    }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, kinetic); }
    [[nodiscard]] std::string lua_text() const { return fmt::format("friction.freewheel{{ Rd = {} }}", kinetic); }
};

inline constexpr text::Option freewheel_options[] = {
    {"Rd", "torque", text::its_own, text::not_negative, "dry friction while it turns forward",
     text::fills<&Freewheel::kinetic>},
};
inline constexpr text::Call freewheel_call{"friction.freewheel", "friction.freewheel{ Rd = 0.1 }", freewheel_options};

}  // namespace dinal::model::laws
