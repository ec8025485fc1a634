// End stops: one or two walls that limit the motion. Rigid ones keep the fraction `restitution` of the speed at an
// impact; elastic ones push back with the torque k x + C x' at the depth x, if positive.
#pragma once

#include <limits>
#include <optional>

#include "text/option.hpp"

namespace dinal::model {

/// velocity+ = -restitution velocity-, against the ground.
struct Walls {
    double lower = -std::numeric_limits<double>::infinity();     ///< rad; -infinity: no lower wall
    double upper = std::numeric_limits<double>::infinity();      ///< rad, above lower; infinity: no upper wall
    double restitution = 1;                                      ///< 0 ... 1
    double stiffness = std::numeric_limits<double>::infinity();  ///< torque per rad; infinite: rigid
    double damping = 0;                                          ///< torque time per rad, of elastic walls

    /// The angle of the wall on this side (positive or not).
    double at(int side) const { return side > 0 ? upper : lower; }
    bool alike() const { return lower == -upper; }
    bool is_elastic() const { return stiffness < std::numeric_limits<double>::infinity(); }
    /// The torque of the elastic wall on this side at the given angle and velocity, with the sign of the penetration.
    double torque(int side, double theta, double velocity) const {
        return stiffness * (theta - at(side)) + damping * velocity;
    }

    /// An error if the numbers are invalid.
    [[nodiscard]] std::optional<text::Error> complaint() const;
    /// An error if theta is beyond a wall by more than rounding; theta is a sum of angles of this size.
    [[nodiscard]] std::optional<text::Error> crossed_by(double theta, double size = 0) const;
    /// "{ lower = -0.8, upper = 0.8, restitution = 0.7 }"
    std::string lua_text() const;
};

inline constexpr text::Range from_0_to_1{"be from 0 to 1", [](double x) { return x >= 0 && x <= 1; }};
inline constexpr text::Option wall_options[] = {
    text::option<&Walls::lower>("lower", "lower wall; none if not given", {.unit = "rad"}),
    text::option<&Walls::upper>("upper", "upper wall, greater than lower; none if not given", {.unit = "rad"}),
    text::option<&Walls::restitution>("restitution",
                                      "ratio of the speeds after and before an impact; 0: the mass stops at the wall",
                                      {.range = from_0_to_1}),
    {"stiffness", "torque per rad", text::its_own, text::positive,
     "of elastic walls, which take the torque stiffness x + damping x' at the depth x while that is positive; rigid if "
     "not given",
     text::fills<&Walls::stiffness>},
    {"damping", "torque time per rad", text::its_own, text::not_negative, "of elastic walls",
     text::fills<&Walls::damping>},
};
inline constexpr text::Call walls_call{"walls", "walls = { lower = -0.8, upper = 0.8, restitution = 0.7 }",
                                       wall_options};

}  // namespace dinal::model
