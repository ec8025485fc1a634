// A linear spring and even friction of Coulomb under one sine, which has closed forms from event to event: starts for
// the search of a steady motion are made of them, and the motion itself where it is a small one (short_slides.hpp).
//
// Everything is in units of its own: y = theta k/M0, x = w0 t, so that y'' + 2 zeta y' + y = sin p - friction, and the
// phase p of the load goes on by r for each x.
#pragma once

#include <numbers>
#include <optional>

#include "analysis/steady.hpp"
#include "theory/theory_modes.hpp"

namespace dinal::analysis::sine {

inline constexpr double half_load = std::numbers::pi;  ///< half a period of the load, as a phase

struct SingleSine {
    double r = 0, zeta = 0;
    double sliding = 0, holding = 0;  ///< Rd/M0 and Re/M0
    double spare = 0;                 ///< 1 - Re/M0, with all digits
    double phase = 0;                 ///< of the load when the drive starts
    double unit = 1, omega0 = 1;      ///< M0/k and w0

    [[nodiscard]] model::State state(const theory::Motion2& y) const { return {unit * y.y, unit * omega0 * y.dy}; }
};

/// None where the system or M is another one, or r is beyond what closed forms take.
std::optional<SingleSine> single_sine(const SteadyQuestion& question);

/// Where the steady motion is when the drive starts, good to rounding as a rule. Ends of slides are looked for in
/// steps, which may step over a short reversal: it is a start for those who prove. None where the closed forms do not
/// lead to one, where the mass never moves, and where its half periods are not opposites of each other.
std::optional<model::State> sine_start(const SingleSine& sine);

}  // namespace dinal::analysis::sine
