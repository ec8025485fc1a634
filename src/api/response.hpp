// sys:response{ ... }: the steady motion over the frequency of M.
#pragma once

#include <optional>
#include <vector>

#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct ResponseOptions {
    double amplitude = 1;
    std::vector<double> frequency = {};
    double points = 200;
    double theta0 = 0, velocity0 = 0;
};
inline constexpr text::Range points_range{"be a whole number from 2 to 1e6",
                                          [](double x) { return text::is_whole(x, 2, 1e6); }};
inline constexpr text::Option response_options[] = {
    {.name = "amplitude",
     .unit = "torque",
     .meaning = "of the harmonic M",
     .filled = text::fills<&ResponseOptions::amplitude>},
    {.name = "M",
     .unit = "torque",
     .meaning = "a function of the frequency that returns the excitation",
     .instead_of_previous = true},
    {.name = "frequency",
     .unit = "cycles per time unit",
     .otherwise = text::needed,
     .meaning = "{ from, to }, or a list of three or more in their order",
     .filled = text::fills<&ResponseOptions::frequency>},
    {.name = "points",
     .range = points_range,
     .meaning = "from one end to the other",
     .filled = text::fills<&ResponseOptions::points>},
    {.name = "theta0",
     .unit = "rad",
     .meaning = "where the first search starts; each other one starts where the one before ended",
     .filled = text::fills<&ResponseOptions::theta0>},
    {.name = "velocity0",
     .unit = "rad per time unit",
     .meaning = "how fast it starts",
     .filled = text::fills<&ResponseOptions::velocity0>},
};
inline constexpr text::Call response_call{"sys:response", "sys:response{ frequency = { 0.05, 3 }, points = 200 }",
                                          response_options};

int response_of_system(lua_State* L);

inline constexpr lua::Doc response_doc{
    "sys:response{ OPTIONS } -> data",
    "The steady motion over the frequency of M, each point from the one before, so that where there are several motions "
    "one branch is followed; from high to low frequencies it may be another one. Columns: frequency, amplitude, lag "
    "(degrees), peak, stops, stuck, stable (1 or 0) and status. Where the motion grows the amplitude is infinite, "
    "where none was found nan.",
    "c = nondimensional{ friction_ratio = 0.5 }:response{ frequency = { 0.75, 1.5, 2 } }\n"
    "print(c.amplitude, c.stops[1])  --> vector{ 1.9726, 0.553775, 0.220479 }\t0.0",
    {&response_call}};

}  // namespace dinal::api
