// integrator.exact: the motion between events in closed form, for an M that has one.
#pragma once

#include "motion/method.hpp"

namespace dinal::motion::exact {

struct Exact {
    static const MethodText about;
    /// An error unless M and system are supported: native terms other than chirp and gaussian, the spring k, no walls,
    /// and dry friction that is constant in each direction.
    [[nodiscard]] std::optional<text::Error> wrong_for(const model::Oscillator& system,
                                                       const model::Excitation& excitation) const;
    /// Returns whether arcs must be short: a strongly damped motion under lines or powers of t, which it follows with a
    /// delay.
    [[nodiscard]] static bool goes_slowly(const model::Oscillator& system, const model::Excitation& excitation);
    Resolution resolution(const model::Oscillator& system) const;
    Run run(const Problem& problem) const;
};

inline constexpr MethodText Exact::about{
    {"integrator.exact", "integrator.exact{}", {}},
    "The motion between events in closed form: free motion at any damping and the response to each term of M, "
    "resonance included. Every event is proven to be the first. It supports an M of native terms (all except "
    "chirp and gaussian; gains, delays, windows and sums of them), k > 0, no second spring or walls, and dry "
    "friction that does not depend on speed. It is the default where it applies, except for lines and powers of "
    "t with a damping ratio above 200.",
    "sys = nondimensional{ friction_ratio = 0.167 }\n"
    "run = sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 0.5, integrator = integrator.exact{} }\n"
    "print(string.format(\"%.9f\", (run:at(3))))  --> 0.155151392"};

}  // namespace dinal::motion::exact
