// integrator.rk4: classical fourth-order Runge-Kutta with exact dry friction: the sign is fixed on each piece, and
// steps are cut at velocity zero and at breaks of M.
#pragma once

#include "motion/method.hpp"

namespace dinal::motion::rk4 {

/// The largest h for which RK4 does not amplify the free motion of this system (2 sqrt(2) / w0 without damping).
double stability_limit(const model::Oscillator& system);

struct Rk4 {
    double h = 0;  ///< the step, at most stability_limit()

    static const MethodText about;
    [[nodiscard]] std::optional<text::Error> wrong_for(const model::Oscillator& system,
                                                       const model::Excitation& excitation) const;
    Resolution resolution(const model::Oscillator& /*system*/) const { return {"h", h}; }
    Cut cut() const { return {.longest = h, .step = h}; }
    Run run(const Problem& problem) const;
};

inline constexpr text::Option rk4_options[] = {
    {"h", "time units", text::needed, text::positive, "the step", text::fills<&Rk4::h>},
};

inline constexpr MethodText Rk4::about{
    {"integrator.rk4", "integrator.rk4{ h = 0.001 }", rk4_options},
    "The classical Runge-Kutta method of fourth order with step h (time units), which keeps its order with dry "
    "friction: a step ends where the velocity becomes zero and at known jumps of M. h must not exceed the "
    "stability limit, 0.45 T0 without damping.",
    "print(integrator.rk4{ h = 0.001 })  --> integrator.rk4{ h = 0.001 }"};

}  // namespace dinal::motion::rk4
