// Coulomb's law: Rd while sliding, at any speed, and up to Re while sticking.
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

/// The options of a user.
struct CoulombTorques {
    double Rd = 0;
    std::optional<double> Re = {};

    [[nodiscard]] Coulomb law() const { return {Rd, Re.value_or(Rd)}; }
};
inline constexpr text::Option coulomb_options[] = {
    {"Rd", "torque", text::needed, text::not_negative, "dry friction while sliding", text::fills<&CoulombTorques::Rd>},
    {"Re", "torque", "Rd", text::not_negative, "breakaway torque, at least Rd", text::fills<&CoulombTorques::Re>},
};
inline constexpr text::Call coulomb_call{"friction.coulomb", "friction.coulomb{ Rd = 0.3, Re = 0.4 }", coulomb_options};

}  // namespace dinal::model::laws
