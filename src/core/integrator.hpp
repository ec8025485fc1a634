// The integrators a run can choose from: plain option structs in a variant, dispatched once a run.
#pragma once

#include <variant>

#include "core/expected.hpp"
#include "core/oscillator.hpp"

namespace dinal {

/// Classical fourth-order Runge-Kutta, exact about dry friction: sign frozen per piece, step cut at velocity zero and
/// at breaks of M. h > 0, at most `rk4_stability_limit`.
struct Rk4 {
    double h = 0;
};

/// The program DINAL as it was printed in 1989, stop rule included. h > 0; no upper limit, its divergence is a result.
struct Dinal1989 {
    enum class Stop {
        listing,  ///< |v| <= |v' - v| against the step before, and the torque within Re
        text,     ///< |v| < |v' - v| / 2, as section 6 of the report says
    };
    double h = 0;
    Stop stop = Stop::listing;
    bool slip = false;  ///< the wrong index in stage 3 with which chapter 6 of the report was computed
};

using Integrator = std::variant<Rk4, Dinal1989>;

/// The largest h for which RK4 does not amplify the free motion of this system (2 sqrt(2) / w0 without damping).
double rk4_stability_limit(const Oscillator& system);

/// What a run uses when none is asked for: rk4 with h = T0/1000, or a tenth of its stability limit if that is less.
Integrator default_integrator(const Oscillator& system);

/// h, whichever integrator it is.
double step_length(const Integrator& integrator);

/// Fails when h is not positive and finite, or rk4 could not be stable with it.
Expected<Integrator> validated(const Integrator& integrator, const Oscillator& system);

}  // namespace dinal
