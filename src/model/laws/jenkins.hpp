// The Jenkins element: a spring in series with a dry slider. Several in parallel form Iwan's hysteresis.
#pragma once

#include <fmt/format.h>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

/// torque = stiffness z, |torque| <= Rd; z' is the slip while the slider sticks, and 0 while it slides.
struct Jenkins {
    double stiffness = 0, kinetic = 0;

    static constexpr bool depends_on_speed = false;
    [[nodiscard]] double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    [[nodiscard]] double holding(Motion /*way*/) const { return kinetic; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, kinetic); }
    [[nodiscard]] std::string lua_text() const {
        return fmt::format("friction.jenkins{{ stiffness = {}, Rd = {} }}", stiffness, kinetic);
    }
};

inline constexpr text::Option jenkins_options[] = {
    {"stiffness", "torque per rad", text::needed, text::positive, "of its spring", text::fills<&Jenkins::stiffness>},
    {"Rd", "torque", text::needed, text::positive, "dry friction of its slider", text::fills<&Jenkins::kinetic>},
};
inline constexpr text::Call jenkins_call{"friction.jenkins", "friction.jenkins{ stiffness = 100, Rd = 1 }",
                                         jenkins_options};

}  // namespace dinal::model::laws
