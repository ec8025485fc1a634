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
    std::optional<double> period = {}, frequency = {}, omega = {};
};
inline constexpr text::Option bifurcation_only_options[] = {
    {.name = "at",
     .otherwise = text::needed,
     .meaning =
         "a function of a point, a table such as { a = 0.5 }, that returns options of sys:simulate, with system = "
         "... and, if need be, another period; for several bodies also of = \"load\", the body to record",
     .wanted = "a function of a point that returns { system = ..., M = ... }"},
    {.name = "period",
     .unit = "time units",
     .range = text::positive,
     .meaning = "time between samples; needed unless `at` returns { period = ... }; or frequency, or omega, instead",
     .filled = text::fills<&BifurcationOptions::period>},
    {.name = "frequency",
     .unit = "cycles per time unit",
     .range = text::positive,
     .meaning = "1/period",
     .filled = text::fills<&BifurcationOptions::frequency>},
    {.name = "omega",
     .unit = "rad per time unit",
     .range = text::positive,
     .meaning = "2 pi/period",
     .filled = text::fills<&BifurcationOptions::omega>},
    {.name = "skip",
     .range = {"be a whole number from 0 to 1e6", [](double x) { return text::is_whole(x, 0, 1e6); }},
     .meaning = "periods to skip while the motion settles",
     .filled = text::fills<&BifurcationOptions::skip>},
    {.name = "keep",
     .range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }},
     .meaning = "periods to record after that, one row each",
     .filled = text::fills<&BifurcationOptions::keep>},
};
inline constexpr text::Option options_of_workers[] = {run_options[1], run_options[3], run_options[4]};
inline constexpr auto bifurcation_options = text::joined(over_option, bifurcation_only_options, options_of_workers);
inline constexpr text::Call bifurcation_call{
    "bifurcation",
    "bifurcation{ over = { a = vector.linspace(0.2, 1.2, 400) }, period = 1.25, at = function(p) return { system "
    "= sys, M "
    "= M } end }",
    bifurcation_options};

int bifurcation(lua_State* L);

inline constexpr lua::Doc bifurcation_doc{
    "bifurcation{ OPTIONS } -> data",
    "Runs a system for each value of a parameter, on all cores, and records theta and velocity once a period: a "
    "motion of one period gives one point, one of two periods two, chaos many. Columns: the parameters, theta, "
    "velocity and error. The rules for the function and for file are those of sweep.",
    "sys = nondimensional{ zeta = 0.1 }\n"
    "b = bifurcation{ over = { a = { 0.5, 1 } }, period = 1, skip = 50, keep = 2, at = function(p)\n"
    "    return { system = sys, M = excitation.harmonic{ amplitude = p.a, frequency = 1 } }\n"
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
