// The documentation of sweeps, and their options besides the parameters.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::sweep {

struct SweepOptions {
    std::optional<double> workers = {};
    double seed = 0;
    std::string file = {};
    std::optional<double> max_time = {};
    std::vector<double> points = {};
};
inline constexpr text::Range workers_range{"be a whole number from 1 to 1000",
                                           [](double x) { return text::is_whole(x, 1, 1000); }};
inline constexpr text::Range seed_range{"be a whole number from 0 to 1e15",
                                        [](double x) { return text::is_whole(x, 0, 1e15); }};
inline constexpr text::Option over_option[] = {
    {.name = "over",
     .otherwise = text::needed,
     .meaning =
         "the parameters and their values, { NAME = values, ... }, or { { \"r\", values }, { \"g\", values } } in an "
         "order of your own",
     .wanted = "names and their values, such as { r = vector.linspace(0.1, 2, 20) }"},
};
inline constexpr text::Option run_options[] = {
    {.name = "run",
     .otherwise = text::needed,
     .meaning =
         "a function of a point, a table such as { r = 0.5, g = 1 }, that returns a table of named numbers and strings",
     .wanted = "a function of a point that returns named numbers"},
    {.name = "workers",
     .otherwise = "one per core",
     .range = workers_range,
     .meaning = "number of threads; the result does not depend on it",
     .filled = text::fills<&SweepOptions::workers>},
    {.name = "seed",
     .range = seed_range,
     .meaning = "seed of math.random: each point has its own random numbers, the same in every run of the sweep",
     .filled = text::fills<&SweepOptions::seed>},
    {.name = "file",
     .meaning =
         "a .csv file for the result; finished points are kept in FILE.part meanwhile, so the same call continues after "
         "a crash",
     .filled = text::fills<&SweepOptions::file>},
    {.name = "max_time",
     .unit = "s",
     .range = text::positive,
     .meaning =
         "time limit of a point; a longer one fails with a message, and the others go on; a single call of Lua's own "
         "libraries (a pattern search, os.execute) ends first",
     .filled = text::fills<&SweepOptions::max_time>},
    {.name = "points",
     .meaning = "{ first, last }: only these rows of the result",
     .filled = text::fills<&SweepOptions::points>},
};
inline constexpr auto sweep_options = text::joined(over_option, run_options);
inline constexpr text::Call sweep_call{
    "sweep", "sweep{ over = { r = vector.linspace(0.1, 2, 20) }, run = function(p) return { A = p.r^2 } end }",
    sweep_options};

int minimise(lua_State* L);

inline constexpr text::Option minimise_options[] = {
    {.name = "over",
     .otherwise = text::needed,
     .meaning = "one or two parameters and the limits of each: { Re = { 0.1, 2 } }",
     .wanted = "names and their limits, such as { Re = { 0.1, 2 } }"},
    {.name = "run",
     .otherwise = text::needed,
     .meaning = "a function of a point, a table such as { Re = 0.5 }, that returns a number",
     .wanted = "a function of a point that returns a number"},
};
inline constexpr text::Call minimise_call{
    "minimise", "minimise{ over = { Re = { 0.1, 2 } }, run = function(p) return (p.Re - 1)^2 end }", minimise_options};

inline constexpr lua::Doc minimise_doc{
    "minimise{ OPTIONS } -> table",
    "Returns the point at which a function is least, its value, and the number of calls: best.NAME, best.value, "
    "best.calls. A coarse grid (17 values of one parameter, 9 x 9 of two) finds the valley, then the golden section or "
    "Nelder and Mead's method refines it to about 1e-8 of the range. A narrower valley may be missed. To "
    "maximise, return the negative.",
    "sys = nondimensional{ zeta = 0.1 }\n"
    "best = minimise{ over = { r = { 0.2, 2 } }, run = function(p)\n"
    "    return -sys:steady{ M = excitation.harmonic{ frequency = p.r } }.amplitude\n"
    "end }\n"
    "print(string.format(\"%.6f %.6f\", best.r, math.sqrt(1 - 2*0.1^2)))  --> 0.989949 0.989949",
    {&minimise_call}};

inline constexpr lua::Doc sweep_doc{
    "sweep{ OPTIONS } -> data",
    "Calls a function at every combination of parameter values (numbers or strings), on all cores. The result "
    "has a row for each point, the parameters in the order of their names, the last one changing fastest, and a "
    "column for each parameter and each name that the function returns; true and false count as 1 and 0, and "
    "missing numbers are nan. If the function fails, the column `error` has the message.\nEach thread has a copy "
    "of the function with all that it uses: local variables, globals, tables, vectors, systems, excitations. So "
    "it cannot change anything outside. Runs, coroutines and open files cannot be copied. Ctrl-C keeps the "
    "finished points in dinal.partial; with file the same call continues.",
    "map = sweep{ over = { r = { 0.4, 1.5 }, g = vector.linspace(0.2, 0.6, 3) }, run = function(p)\n"
    "    s = nondimensional{ friction_ratio = p.g }:steady{ M = excitation.harmonic{ frequency = p.r } }\n"
    "    return { A = s.amplitude, stops = s.stops }\n"
    "end }\n"
    "print(map:select(\"g\", \"r\", \"A\", \"stops\"))\n"
    "--> data: 6 rows of g, r, A, stops\n"
    "-->   i    g    r         A  stops\n"
    "-->   1  0.2  0.4   1.13218      2\n"
    "-->   2  0.2  1.5  0.765942      0\n"
    "-->   3  0.4  0.4   1.11113      2\n"
    "-->   4  0.4  1.5  0.653197      0\n"
    "-->   5  0.6  0.4   1.02745      2\n"
    "-->   6  0.6  1.5       0.4      0",
    {&sweep_call}};

}  // namespace dinal::sweep
