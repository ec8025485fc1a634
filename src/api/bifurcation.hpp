// bifurcation{ ... }: what a motion does once a period, over a parameter; on top of the workers of a sweep.
#pragma once

#include <optional>

#include "api/sweep_options.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct BifurcationOptions {
    double skip = 200;
    double keep = 100;
    std::optional<double> period = {};
};
inline constexpr text::Option bifurcation_only_options[] = {
    {.name = "run",
     .otherwise = text::needed,
     .meaning = "a function of a point, a table such as { a = 0.5 }, that returns a system, its M, and if need be a "
                "table of more options for sys:simulate, or another period",
     .wanted = "a function of a point that returns a system and an M"},
    {.name = "period",
     .unit = "time units",
     .range = text::positive,
     .meaning = "from one look at the motion to the next; needed unless run returns { period = ... }",
     .filled = text::fills<&BifurcationOptions::period>},
    {.name = "skip",
     .range = {"be a whole number from 0 to 1e6", [](double x) { return text::is_whole(x, 0, 1e6); }},
     .meaning = "periods that are run first, for the motion to settle",
     .filled = text::fills<&BifurcationOptions::skip>},
    {.name = "keep",
     .range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }},
     .meaning = "periods after that, each of which gives a row",
     .filled = text::fills<&BifurcationOptions::keep>},
};
inline constexpr text::Option options_of_workers[] = {sweep_options[1], sweep_options[3], sweep_options[4]};
inline constexpr auto bifurcation_options = text::joined(bifurcation_only_options, options_of_workers);
inline constexpr text::Call bifurcation_call{
    "bifurcation",
    "bifurcation{ a = vector.linspace(0.2, 1.2, 400), period = 1.25, run = function(p) return sys, M end }",
    bifurcation_options};

int bifurcation(lua_State* L);

inline constexpr lua::Doc bifurcation_doc{
    "bifurcation{ NAME = values, ..., OPTIONS } -> data",
    "Runs a system for each value of a parameter, on all cores at once, and notes theta and velocity once a period: a "
    "motion of one period is a point, one of two periods two points, chaos many. The result has the columns of the "
    "parameters, theta, velocity and error; its plot shows points. As to what the function may use, and a file, see sweep.",
    "b = bifurcation{ a = { 0.5, 1 }, period = 1, skip = 50, keep = 2, run = function(p)\n"
    "    return nondimensional{ zeta = 0.1 }, excitation.harmonic{ amplitude = p.a, frequency = 1 }\n"
    "end }\n"
    "print(b:select(\"a\", \"theta\"))\n"
    "--> data: 4 rows of a, theta\n"
    "-->   i    a  theta\n"
    "-->   1  0.5   -2.5\n"
    "-->   2  0.5   -2.5\n"
    "-->   3    1     -5\n"
    "-->   4    1     -5",
    {&bifurcation_call}};

}  // namespace dinal::api
