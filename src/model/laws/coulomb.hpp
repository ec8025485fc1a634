// Laws of torques that do not depend on the speed, also in addition to another law.
#pragma once

#include <fmt/format.h>
#include <array>

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

/// Rd while sliding and up to Re while sticking.
struct Coulomb {
    double kinetic = 0;    ///< Rd
    double breakaway = 0;  ///< Re >= Rd

    static constexpr bool depends_on_speed = false;
    double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    double holding(Motion /*way*/) const { return breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, breakaway); }
};

/// The torques as given by a user.
struct CoulombTorques {
    double Rd = 0;
    std::optional<double> Re = {};

    Coulomb law() const { return {Rd, Re.value_or(Rd)}; }
};
inline constexpr text::Option coulomb_options[] = {
    {"Rd", "torque", text::needed, text::not_negative, "dry friction while sliding", text::fills<&CoulombTorques::Rd>},
    {"Re", "torque", "Rd", text::not_negative, "breakaway torque, at least Rd", text::fills<&CoulombTorques::Re>},
};
inline constexpr text::Call coulomb_call{"friction.coulomb", "friction.coulomb{ Rd = 0.3, Re = 0.4 }", coulomb_options};

/// Different numbers each way: a brake with a wedge, a worn ratchet.
struct AsymmetricCoulomb {
    Coulomb forward, backward;

    static constexpr bool depends_on_speed = false;
    const Coulomb& of(Motion way) const { return way == Motion::backward ? backward : forward; }
    double sliding(Motion way, double /*speed*/) const { return of(way).kinetic; }
    double holding(Motion way) const { return of(way).breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        if (auto wrong = wrong_torques("forward.", forward.kinetic, forward.breakaway)) return wrong;
        return wrong_torques("backward.", backward.kinetic, backward.breakaway);
    }
    std::string lua_text() const {
        return fmt::format(
            "friction.asymmetric{{ forward = {{ Rd = {}, Re = {} }}, backward = {{ Rd = {}, Re = {} }} }}",
            forward.kinetic, forward.breakaway, backward.kinetic, backward.breakaway);
    }
};

inline constexpr text::Option asymmetric_options[] = {
    {.name = "forward",
     .otherwise = text::needed,
     .meaning = "friction of a motion forward",
     .wanted = "a table such as { Rd = 0.3, Re = 0.4 }",
     .fields = {&coulomb_call}},
    {.name = "backward",
     .otherwise = text::needed,
     .meaning = "friction of a motion backward",
     .wanted = "a table such as { Rd = 0.3, Re = 0.4 }",
     .fields = {&coulomb_call}},
};
inline constexpr text::Call asymmetric_call{
    "friction.asymmetric", "friction.asymmetric{ forward = { Rd = 0.1 }, backward = { Rd = 0.3, Re = 0.5 } }",
    asymmetric_options};

/// A one-way clutch: it turns forward against Rd and holds any torque backward.
struct Freewheel {
    double kinetic = 0;  ///< Rd, also the breakaway torque forward

    static constexpr bool depends_on_speed = false;
    double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    double holding(Motion way) const {
        return way == Motion::backward ? std::numeric_limits<double>::infinity() : kinetic;
    }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, kinetic); }
    std::string lua_text() const { return fmt::format("friction.freewheel{{ Rd = {} }}", kinetic); }
};

inline constexpr text::Option freewheel_options[] = {
    {"Rd", "torque", text::its_own, text::not_negative, "dry friction while it turns forward",
     text::fills<&Freewheel::kinetic>},
};
inline constexpr text::Call freewheel_call{"friction.freewheel", "friction.freewheel{ Rd = 0.1 }", freewheel_options};

/// Laws in parallel on one contact: one of any kind, and constant torques.
template <bool speed>
struct Sum {
    Friction main;
    std::array<double, 2> more_sliding{}, more_holding{};  ///< backward and forward

    static constexpr bool depends_on_speed = speed;
    double sliding(Motion way, double at) const { return main.sliding(way, at) + more_sliding[side_of(way)]; }
    double holding(Motion way) const { return main.holding(way) + more_holding[side_of(way)]; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return main.complaint(); }
    std::size_t ranges() const { return more_sliding[0] == more_sliding[1] ? main.ranges() : 0; }
    SpeedRange range(std::size_t i) const {
        SpeedRange range = main.range(i);
        range.torque += more_sliding[0];
        return range;
    }
    double slope(double at) const { return main.slope(at); }
    double scale(double at) const { return main.scale(at); }
};

}  // namespace dinal::model::laws
