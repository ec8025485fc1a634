// The integrators a run can choose from: plain option structs in a variant, dispatched once a run.
#pragma once

#include <limits>
#include <variant>

#include "model/oscillator.hpp"
#include "text/expected.hpp"

namespace dinal::motion {

/// Chebyshev panels between events and breaks of M, each solved to rounding whatever M is.
struct Spectral {
    double tolerance = 1e-12;  ///< of the motion, relative, on each panel; 0 < tolerance < 1
    double max_panel = std::numeric_limits<double>::infinity();  ///< longest panel, time units; > 0
};
/// No panel is longer than this many natural periods, whatever max_panel says.
inline constexpr double longest_panel = 0.6;

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

using Integrator = std::variant<Spectral, Rk4, Dinal1989>;

/// The largest h for which RK4 does not amplify the free motion of this system (2 sqrt(2) / w0 without damping).
double rk4_stability_limit(const model::Oscillator& system);

/// The distance between two evaluations of M, which times must be able to tell apart.
double resolution(const Integrator& integrator, const model::Oscillator& system);

/// Fails when an option is out of its range, or rk4 could not be stable with its h.
text::Expected<Integrator> validated(const Integrator& integrator, const model::Oscillator& system);

}  // namespace dinal::motion
