// sys:response{ ... }: the steady motion over the frequency of M, its amplitude, or any parameter of a function.
#pragma once

#include <optional>
#include <string>

#include "api/system_options.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct ResponseOptions {
    double amplitude = 1;
    std::optional<double> frequency = {}, omega = {}, period = {};
    double theta0 = 0, velocity0 = 0;
    bool between = false, doubled = false;
    std::string of = {};
};
inline constexpr text::Option response_options[] = {
    {.name = "over",
     .otherwise = text::needed,
     .meaning =
         "the varied parameter and its values: { frequency = values }, also omega, period or amplitude of a harmonic "
         "M; with `at`, { NAME = values } for any name. Of two parameters the last in the alphabet is followed at each "
         "value of the other, or the second of { { \"b\", values }, { \"a\", values } }",
     .wanted = "a name and its values, such as { frequency = vector.linspace(0.05, 3, 200) }"},
    {.name = "at",
     .meaning =
         "a function of a point, a table such as { speed = 0.5 }, that returns the options of sys:steady there, and "
         "system = ... if the system changes; without `at` M is harmonic",
     .wanted = "a function of a point that returns options of sys:steady"},
    text::option<&ResponseOptions::amplitude>("amplitude", "of the harmonic M", {.unit = "torque"}),
    text::option<&ResponseOptions::frequency>("frequency",
                                              "of the harmonic M, if its amplitude is varied; or omega, or period",
                                              {.unit = "cycles per time unit", .range = text::positive}),
    text::option<&ResponseOptions::omega>("omega", "the same as angular frequency",
                                          {.unit = "rad per time unit", .range = text::positive}),
    text::option<&ResponseOptions::period>("period", "the same as the length of a period",
                                           {.unit = "time units", .range = text::positive}),
    text::option<&ResponseOptions::between>(
        "between",
        "true keeps also the rows between the values, which c:plot() draws in any case: around folds and along unstable "
        "branches; and adds one at a resonance where the motion grows"),
    text::option<&ResponseOptions::doubled>(
        "doubled", "true also follows the motions of twice the period that begin at period doublings"),
    text::option<&ResponseOptions::theta0>("theta0", "start of the first search", {.unit = "rad"}),
    text::option<&ResponseOptions::velocity0>("velocity0", "initial velocity", {.unit = "rad per time unit"}),
    text::option<&ResponseOptions::of>(
        "of",
        "the named body or link whose amplitude tells where branches fold, as in c.points and c.jumps; one that "
        "goes round has none, and then each value is searched from the one before",
        {.otherwise = "the first body"}),
};
inline constexpr text::Call response_call{"sys:response",
                                          "sys:response{ over = { frequency = vector.linspace(0.05, 3, 200) } }",
                                          response_options, false, &with_call};

int response_of_system(lua_State* L);

inline constexpr lua::Doc response_doc{
    "sys:response{ OPTIONS } -> data",
    "The steady motion over a list of values: of the frequency or the amplitude of a harmonic M, or of any parameter that "
    "`at` uses. Two lists give a map. Columns: the varied parameter (M0 for the amplitude), amplitude, lag (rad), peak, stops, stuck, stable (1 "
    "or 0), branch and status. The amplitude is infinite where the motion grows, and nan where no motion was found. If "
    "several motions can exist (with a spring of its own, feedback, walls, states, or Re > Rd), whole branches are "
    "followed, round their folds and along their unstable sides, which c:plot() draws dotted; a value then has a row for "
    "each branch. Limit cycles and steady sliding are followed in the same way. c.points lists special points: kind is "
    "\"fold\" (the branch turns back), \"doubling\" (a motion of twice the period begins), \"pitchfork\" (unsymmetric "
    "motions begin), \"torus\" (a second frequency begins) or \"hopf\" (a limit cycle begins at a rest, as squeal does), "
    "with the place, amplitude, period and branch. Branches connected to either end of the list are found; an isolated "
    "one needs a start on it. c.jumps lists where a sweep leaves a branch: the place, sweep (\"up\" or \"down\"), the "
    "amplitudes from and to, and the status of the new motion. For a linear spring under a harmonic M, c.linearised and "
    "c.den_hartog are the curves of equivalent viscous damping and of Den Hartog (nan where the motion stops); "
    "c:plot{ overlay = \"linearised\" } adds one to the plot, overlay = \"jumps\" the jumps. Over two parameters the "
    "branches are followed over the last one in alphabetical order at each value of the other, from the same start. "
    "c:plot() is then a map of the amplitude, of the greatest one where several motions are stable; c.points has both "
    "parameters, and its column curve numbers the curves that the points form in their plane, which "
    "c:plot{ overlay = \"points\" } draws into the map. Give the first parameter so many values that the points of a curve "
    "are near each other. sweep{ workers = n } with sys:steady makes larger maps. Named bodies and links need `at`, and "
    "have columns of their own, as in \"load.amplitude\"; under controllers that sample or wait each value is searched "
    "from the one before.",
    "c = nondimensional{ friction_ratio = 0.5 }:response{ over = { frequency = { 0.75, 1.5, 2 } } }\n"
    "print(c.amplitude, c.stops[1])  --> vector{ 1.9726, 0.553775, 0.220479 }\t0.0\n"
    "sys = system{ I = 1, k = 1, C = 0.05, Rd = 0.02, spring = spring.polynomial{ [3] = 0.5 } }\n"
    "c = sys:response{ amplitude = 0.5, over = { frequency = vector.linspace(0.15, 0.4, 50) } }\n"
    "for i, jump in ipairs(c.jumps) do\n"
    "    print(string.format(\"%s at %.5f: %.3f to %.3f\", jump.sweep, jump.frequency, jump.from, jump.to))\n"
    "end\n"
    "--> down at 0.21658: 0.877 to 1.761\n"
    "squeal = system{ I = 1, k = 4, Rd = 0.3, Re = 0.6 }\n"
    "c = squeal:response{ over = { speed = { 0.05, 0.1 } }, at = function(p) return { belt = p.speed } end }\n"
    "print(c.speed, c.amplitude)  --> vector{ 0.05, 0.1 }\tvector{ 0.0790569, 0.0901388 }\n"
    "squeal = system{ I = 1, k = 4, C = 0.15, friction = friction.stribeck{ Rd = 0.3, Re = 0.6, speed = 0.3 } }\n"
    "c = squeal:response{ over = { speed = vector.linspace(0.4, 1, 13) }, at = function(p) return { belt = p.speed } end }\n"
    "for i, point in ipairs(c.points) do print(point.kind, string.format(\"%.6f\", point.speed)) end\n"
    "--> fold\t0.868343\n"
    "--> hopf\t0.533848\n"
    "sys = system{ I = 1, k = 1, C = 0.1, spring = spring.polynomial{ [3] = 0.5 } }\n"
    "c = sys:response{ over = { amplitude = { 0.3, 0.4 }, omega = vector.linspace(0.8, 2, 25) } }\n"
    "for i, p in ipairs(c.points) do print(string.format(\"%.0f %s %.1f %.5f\", p.curve, p.kind, p.M0, p.omega)) end\n"
    "--> 1 fold 0.3 1.55558\n"
    "--> 1 fold 0.4 1.73797\n"
    "--> 2 fold 0.3 1.26161\n"
    "--> 2 fold 0.4 1.31281\n"
    "rig = system{ bodies = { a = { I = 1, k = 1, C = 0.1 }, b = { I = 1, k = 1 } },\n"
    "    links = { rod = { \"a\", \"b\", k = 4 } } }\n"
    "c = rig:response{ over = { omega = { 0.5, 2 } }, at = function(p)\n"
    "    return { M = { a = excitation.harmonic{ omega = p.omega } } }\n"
    "end }\n"
    "print(c[\"b.amplitude\"])  --> vector{ 0.609125, 0.266643 }",
    {&response_call}};

}  // namespace dinal::api
