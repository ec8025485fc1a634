// integrator.dopri5: the adaptive pair of order 5 by Dormand and Prince (1980), with the dense output of Hairer,
// Norsett and Wanner, Solving Ordinary Differential Equations I, II.6.
#pragma once

#include "motion/engine/part.hpp"
#include "motion/method.hpp"

namespace dinal::motion::dopri5 {

inline constexpr Pair::Stage stages[] = {
    {1.0 / 5, {1.0 / 5}},
    {3.0 / 10, {3.0 / 40, 9.0 / 40}},
    {4.0 / 5, {44.0 / 45, -56.0 / 15, 32.0 / 9}},
    {8.0 / 9, {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729}},
    {1, {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656}},
    {1, {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}},
};

inline constexpr Pair pair{
    .power = 5,
    .stages = stages,
    .error = {71.0 / 57600, 0, -71.0 / 16695, 71.0 / 1920, -17253.0 / 339200, 22.0 / 525, -1.0 / 40},
    .bulge = {-12715105075.0 / 11282082432, 0, 87487479700.0 / 32700410799, -10690763975.0 / 1880347072,
              701980252875.0 / 199316789632, -1453857185.0 / 822651844, 69997945.0 / 29380423},
};

struct Dopri5 {
    double tolerance = 0;  ///< error of a step relative to the greatest velocity in it

    static const MethodText about;
    Resolution resolution(const model::Oscillator& system) const {
        return {"T0/27", system.natural_period() / 27, false};
    }
    Cut cut() const { return {.tolerance = tolerance, .pair = &pair}; }
    Run run(const Problem& problem) const { return engine::run(problem, cut()); }
};

inline constexpr text::Option dopri5_options[] = {
    {"tolerance", "", text::needed, text::between_0_and_1,
     "estimated error of a step, relative to the greatest velocity in it (of a state its value)",
     text::fills<&Dopri5::tolerance>},
};

inline constexpr MethodText Dopri5::about{
    {"integrator.dopri5", "integrator.dopri5{ tolerance = 1e-9 }", dopri5_options},
    "The explicit Runge-Kutta pair of order 5 by Dormand and Prince, the usual adaptive method of other programs. A step "
    "is as long as its estimated error allows: tolerance times the greatest velocity in it, for states times the "
    "greatest value. Steps end at events, which are located on the dense output of order 4, and at breaks of M. M is "
    "sampled as by integrator.spectral, and checked between the samples.",
    "sys = nondimensional{ friction_ratio = 0.167 }\n"
    "run = sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 0.5, integrator = integrator.dopri5{ tolerance = 1e-6 } }\n"
    "print(string.format(\"%.4f\", (run:at(3))))  --> 0.1552"};

}  // namespace dinal::motion::dopri5
