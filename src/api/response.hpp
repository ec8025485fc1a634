// sys:response{ ... }: the steady motion over the frequency of M, its amplitude, or any parameter of a function.
#pragma once

#include <optional>
#include <string>

#include "api/system_options.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct ResponseOptions {
    double points = 200;
    double theta0 = 0, velocity0 = 0;
    std::optional<std::string> name = {};
};
inline constexpr text::Range points_range{"be a whole number from 2 to 1e6",
                                          [](double x) { return text::is_whole(x, 2, 1e6); }};
inline constexpr text::Option response_options[] = {
    {.name = "frequency",
     .unit = "cycles per time unit",
     .otherwise = "what M knows",
     .meaning = "of M: { from, to }, or a list of three or more in their order; or one number, where something else is "
                "varied"},
    {.name = "amplitude",
     .unit = "torque",
     .otherwise = "1",
     .meaning = "of the harmonic M: a number, or { from, to } or a list, over which the response is found"},
    {.name = "M",
     .unit = "torque",
     .meaning = "instead of a harmonic a function of what is varied that returns the excitation, and if need be the "
                "system, too"},
    {.name = "over", .meaning = "{ from, to } or a list of any other parameter, with which M is called"},
    {.name = "name",
     .otherwise = "\"frequency\", \"M0\" or \"parameter\"",
     .meaning = "of the column of what is varied",
     .filled = text::fills<&ResponseOptions::name>},
    {.name = "points",
     .range = points_range,
     .meaning = "from one end of { from, to } to the other",
     .filled = text::fills<&ResponseOptions::points>},
    {.name = "theta0",
     .unit = "rad",
     .meaning = "where the first search starts",
     .filled = text::fills<&ResponseOptions::theta0>},
    {.name = "velocity0",
     .unit = "rad per time unit",
     .meaning = "how fast it starts",
     .filled = text::fills<&ResponseOptions::velocity0>},
};
inline constexpr text::Call response_call{"sys:response", "sys:response{ frequency = { 0.05, 3 }, points = 200 }",
                                          response_options, false, &with_call};

int response_of_system(lua_State* L);

inline constexpr lua::Doc response_doc{
    "sys:response{ OPTIONS } -> data",
    "The steady motion over the frequency of M, its amplitude, or a parameter of a function. Columns: frequency (or what "
    "is varied), amplitude, lag (rad), peak, stops, stuck, stable (1 or 0), branch and status. Where the motion grows "
    "the amplitude is infinite, where none was found nan; between { from, to } a row is added at a resonance where it "
    "grows. Where there can be several motions at once, with a spring of its own, feedback, walls, or Re > Rd, whole "
    "branches are followed, round their folds and along their unstable sides, which c:plot() draws dotted, so there are "
    "more rows than points; what a sweep meets from either end is found, an island beside it only from a start on it. "
    "c.jumps then tells where a sweep leaves a branch: the place, sweep (\"up\" or \"down\"), the amplitudes from and to, "
    "and status, what it lands on. Of a linear spring under a harmonic M c.linearised and c.den_hartog are the curves of "
    "equivalent viscous damping and of Den Hartog (nan where the motion stops); c:plot{ overlay = \"linearised\" } draws "
    "them beside c, \"jumps\" as well.",
    "c = nondimensional{ friction_ratio = 0.5 }:response{ frequency = { 0.75, 1.5, 2 } }\n"
    "print(c.amplitude, c.stops[1])  --> vector{ 1.9726, 0.553775, 0.220479 }\t0.0\n"
    "sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.02, spring = spring.polynomial{ [3] = 0.5 } }\n"
    "c = sys:response{ amplitude = 0.5, frequency = { 0.15, 0.4 }, points = 50 }\n"
    "for i, jump in ipairs(c.jumps) do\n"
    "    print(string.format(\"%s at %.5f: %.3f to %.3f\", jump.sweep, jump.frequency, jump.from, jump.to))\n"
    "end\n"
    "--> down at 0.21658: 0.877 to 1.761",
    {&response_call}};

}  // namespace dinal::api
