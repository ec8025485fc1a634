// Coulomb's law: Rd while sliding, at whatever speed, and up to Re while standing.
#pragma once

#include "model/friction.hpp"
#include "text/option.hpp"

namespace dinal::model::laws {

struct Coulomb {
    double kinetic = 0;    ///< Rd
    double breakaway = 0;  ///< Re >= Rd

    static constexpr bool depends_on_speed = false;
    [[nodiscard]] double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    [[nodiscard]] double holding(Motion /*way*/) const { return breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, breakaway); }
};

/// What a user says about it.
struct CoulombTorques {
    double Rd = 0;
    std::optional<double> Re = {};

    [[nodiscard]] Coulomb law() const { return {Rd, Re.value_or(Rd)}; }
};
inline constexpr text::Option coulomb_options[] = {
    {.name = "Rd",
     .unit = "torque",
     .otherwise = text::needed,
     .range = text::not_negative,
     .meaning = "dry friction while moving",
     .filled = text::fills<&CoulombTorques::Rd>},
    {.name = "Re",
     .unit = "torque",
     .otherwise = "Rd",
     .range = text::not_negative,
     .meaning = "what sticking can hold, at least Rd",
     .filled = text::fills<&CoulombTorques::Re>},
};
inline constexpr text::Call coulomb_call{"friction.coulomb", "friction.coulomb{ Rd = 0.3, Re = 0.4 }", coulomb_options};

}  // namespace dinal::model::laws
