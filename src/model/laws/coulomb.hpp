// Coulomb's law: Rd while sliding, at whatever speed, and up to Re while standing.
#pragma once

#include "model/friction.hpp"

namespace dinal::model::laws {

struct Coulomb {
    double kinetic = 0;    ///< Rd
    double breakaway = 0;  ///< Re >= Rd

    static constexpr bool depends_on_speed = false;
    [[nodiscard]] double sliding(Motion /*way*/, double /*speed*/) const { return kinetic; }
    [[nodiscard]] double holding(Motion /*way*/) const { return breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const { return wrong_torques("", kinetic, breakaway); }
};

}  // namespace dinal::model::laws
