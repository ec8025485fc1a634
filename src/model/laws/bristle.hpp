// Friction with an internal state: bristles that bend before they slip. The LuGre model of Canudas de Wit, Olsson,
// Astrom and Lischinsky (1995), and Dahl's (1968), its case without damping and with Re = Rd.
#pragma once

#include <fmt/format.h>
#include <cmath>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

/// torque = stiffness z + damping z' + viscous v with z' = v - stiffness |v| z/g(v), g(v) = Rd + (Re - Rd)
/// exp(-(v/speed)^2).
struct Bristle final : BendingLaw {
    double kinetic = 0;                    ///< Rd
    std::optional<double> breakaway = {};  ///< Re >= Rd
    double speed = std::numeric_limits<double>::infinity();
    double stiffness = 0, damping = 0, viscous = 0;
    bool dahl = false;

    static constexpr bool depends_on_speed = true;
    double greatest() const { return breakaway.value_or(kinetic); }
    /// The torque of steady slip without its viscous part.
    double steady(double v) const {
        const double x = v / speed;
        return kinetic + (greatest() - kinetic) * std::exp(-x * x);
    }
    double bend_rate(double v, double z) const override { return v - stiffness * std::fabs(v) * z / steady(v); }
    double torque(double v, double z) const override { return stiffness * z + damping * bend_rate(v, z) + viscous * v; }
    double sliding(Motion /*way*/, double v) const { return steady(v) + viscous * v; }
    double holding(Motion /*way*/) const { return greatest(); }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, greatest()); }
    std::string lua_text() const;
};

inline constexpr text::Option dahl_options[] = {
    {"Rd", "torque", text::needed, text::positive, "dry friction in steady sliding", text::fills<&Bristle::kinetic>},
    {"stiffness", "torque per rad", text::needed, text::positive, "of the bristles", text::fills<&Bristle::stiffness>},
};
inline constexpr text::Option lugre_options[] = {
    dahl_options[0],
    {"Re", "torque", "Rd", text::positive, "friction in steady sliding at small speeds, at least Rd",
     text::fills<&Bristle::breakaway>},
    {"speed", "rad per time unit", text::its_own, text::positive_or_infinite,
     "speed at which Re - Rd has fallen to 1/e", text::fills<&Bristle::speed>},
    dahl_options[1],
    {"damping", "torque time per rad", text::its_own, text::not_negative, "of the bristles",
     text::fills<&Bristle::damping>},
    {"viscous", "torque time per rad", text::its_own, text::not_negative, "viscous friction of the sliding",
     text::fills<&Bristle::viscous>},
};
inline constexpr text::Call dahl_call{"friction.dahl", "friction.dahl{ Rd = 0.3, stiffness = 1000 }", dahl_options};
inline constexpr text::Call lugre_call{
    "friction.lugre", "friction.lugre{ Rd = 0.3, Re = 0.4, speed = 0.01, stiffness = 1000, damping = 3 }",
    lugre_options};

inline std::string Bristle::lua_text() const {
    return dahl ? text::lua_text("friction.dahl", dahl_options, *this, text::Defaults::left_out)
                : text::lua_text("friction.lugre", lugre_options, *this, text::Defaults::left_out);
}

// The Jenkins element: a spring in series with a dry slider. Several in parallel form Iwan's hysteresis.

/// torque = stiffness z, |torque| <= Rd; z' is the slip while the slider sticks, and 0 while it slides.
struct Jenkins {
    double stiffness = 0, kinetic = 0;

    static constexpr bool depends_on_speed = false;
    double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    double holding(Motion /*way*/) const { return kinetic; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, kinetic); }
    std::string lua_text() const {
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
