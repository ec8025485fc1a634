// Coulomb's law with different numbers each way: a brake with a wedge, a worn ratchet.
#pragma once

#include <fmt/format.h>

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
    [[nodiscard]] std::string lua_text() const {
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

}  // namespace dinal::model::laws
