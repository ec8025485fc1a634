// An integrator that dinal does not have: Heun's method of second order, with steps that end at breaks of M and at
// velocity zero. This file and its row in conformance_test.cpp are all that it takes.
#pragma once

#include "motion/method.hpp"

namespace dinal::truth {

struct Heun {
    double h = 0;

    static const motion::MethodText about;
    [[nodiscard]] motion::Resolution resolution(const model::Oscillator& /*system*/) const { return {"h", h}; }
    [[nodiscard]] motion::Trajectory run(const motion::Problem& problem) const;
};

inline constexpr text::Option heun_options[] = {
    {.name = "h",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "the step",
     .filled = text::fills<&Heun::h>},
};

inline constexpr motion::MethodText Heun::about{
    {"integrator.heun", "integrator.heun{ h = 0.001 }", heun_options}, "Heun's method of second order.", ""};

}  // namespace dinal::truth
