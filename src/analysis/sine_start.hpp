// A linear spring and symmetric Coulomb friction under one sine, with closed forms between events: they provide the
// start of a search, which is then one return from its end.
//
// Dimensionless: y = theta k/M0, x = w0 t, so that y'' + 2 zeta y' + y = sin p - friction; the phase p of the load
// advances by r for each x.
#pragma once

#include <numbers>
#include <optional>

#include "analysis/steady.hpp"
#include "theory/theory_free.hpp"

namespace dinal::analysis {

inline constexpr double half_load = std::numbers::pi;  ///< half a period of the load, as a phase

struct SingleSine {
    double r = 0, zeta = 0;
    double sliding = 0, holding = 0;  ///< Rd/M0 and Re/M0
    double spare = 0;                 ///< 1 - Re/M0 without loss of digits
    double phase = 0;                 ///< phase of the load when the drive starts
    double unit = 1, omega0 = 1;      ///< M0/k and w0

    model::State state(const theory::Motion2& y) const { return {unit * y.y, unit * omega0 * y.dy}; }
};

/// None for another kind of system or M, or if r is out of the range of the closed forms.
std::optional<SingleSine> single_sine(const SteadyQuestion& question);

/// The state of the steady motion when the drive starts, usually accurate to rounding. Its search may step over a short
/// reversal, so callers must verify it. None if the closed forms lead nowhere, the mass never moves, or half periods
/// are not opposite.
std::optional<model::State> sine_start(const SingleSine& sine);

}  // namespace dinal::analysis
