// Coulomb's law with other numbers each way: a brake with a wedge, a ratchet worn smooth.
#pragma once

#include "model/laws/coulomb.hpp"

namespace dinal::model::laws {

struct AsymmetricCoulomb {
    Coulomb forward, backward;

    static constexpr bool depends_on_speed = false;
    [[nodiscard]] const Coulomb& of(Motion way) const { return way == Motion::backward ? backward : forward; }
    [[nodiscard]] double sliding(Motion way, double /*speed*/) const { return of(way).kinetic; }
    [[nodiscard]] double holding(Motion way) const { return of(way).breakaway; }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        if (auto wrong = wrong_torques("forward.", forward.kinetic, forward.breakaway)) return wrong;
        return wrong_torques("backward.", backward.kinetic, backward.breakaway);
    }
};

}  // namespace dinal::model::laws
