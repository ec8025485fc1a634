// Stribeck's law: friction falls with speed from Re at standstill towards Rd, as a lubricant is drawn in.
#pragma once

#include <cmath>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

/// Rd + (Re - Rd) exp(-(|v|/speed)^shape); shape 2 is Stribeck's curve after Bo and Pavelescu (1982), 1 Tustin's
/// (1947).
struct Stribeck {
    double kinetic = 0;    ///< Rd, at high speed
    double breakaway = 0;  ///< Re >= Rd
    double speed = 0;      ///< the speed at which the difference has fallen to 1/e
    double shape = 2;

    static constexpr bool depends_on_speed = true;
    double sliding(Motion /*way*/, double v) const {
        if (v == 0) return breakaway;
        constexpr double farthest = 2;  // limits the exponent below speed 0, where odd powers grow
        const double exponent = speed_ratio_power(v);
        const bool grows = v < 0 && std::fmod(shape, 2) == 1;
        return kinetic + (breakaway - kinetic) * std::exp(grows ? std::min(exponent, farthest) : -exponent);
    }
    double holding(Motion /*way*/) const { return breakaway; }
    /// Beyond flat_from() the law is Coulomb's to rounding.
    std::size_t ranges() const { return std::isfinite(flat_from()) ? 2 : 1; }
    SpeedRange range(std::size_t i) const {
        if (i == 1) return {.from = flat_from(), .straight = true, .torque = kinetic};
        return {.to = flat_from()};
    }
    double slope(double v) const;
    double scale(double v) const;
    [[nodiscard]] std::optional<text::Error> complaint() const;
    std::string lua_text() const;

private:
    /// (|v|/speed)^shape
    double speed_ratio_power(double v) const {
        const double x = std::fabs(v / speed);
        return shape == 2 ? x * x : shape == 1 ? x : std::pow(x, shape);
    }
    double flat_from() const {
        constexpr double nothing = 38;  // exp(-nothing) < 2^-54
        return speed * (shape == 2 ? std::sqrt(nothing) : std::pow(nothing, 1 / shape));
    }
};

inline constexpr text::Option stribeck_options[] = {
    {"Rd", "torque", text::needed, text::not_negative, "dry friction at high speed", text::fills<&Stribeck::kinetic>},
    {"Re", "torque", text::needed, text::not_negative, "friction at speed 0 and breakaway torque, at least Rd",
     text::fills<&Stribeck::breakaway>},
    {"speed", "rad per time unit", text::needed, text::positive, "speed at which Re - Rd has fallen to 1/e",
     text::fills<&Stribeck::speed>},
    text::option<&Stribeck::shape>("shape", "the power of the speed in the exponent", {.range = text::positive}),
};
inline constexpr text::Call stribeck_call{"friction.stribeck", "friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.1 }",
                                          stribeck_options};

inline double Stribeck::slope(double v) const {
    if (v == 0) return 0;
    const double exponent = speed_ratio_power(v);
    return -(breakaway - kinetic) * shape * exponent / v * std::exp(-exponent);
}
/// A measured scale: 4.5 speeds for shape 1, 1.26 for shape 2, 0.7 for shape 3; larger where friction is nearly Rd.
inline double Stribeck::scale(double v) const {
    constexpr double at_zero = 4.5, narrower = 1.83, less = 20;
    return speed * at_zero * std::pow(shape, -narrower) * std::exp(std::min(speed_ratio_power(v), 4 * less) / less);
}
inline std::optional<text::Error> Stribeck::complaint() const {
    if (auto wrong = wrong_torques("", kinetic, breakaway)) return wrong;
    if (auto wrong = text::complaint(stribeck_options, *this)) return wrong;
    return std::nullopt;
}
inline std::string Stribeck::lua_text() const {
    return text::lua_text(stribeck_call.name, stribeck_options, *this, text::Defaults::left_out);
}

}  // namespace dinal::model::laws
