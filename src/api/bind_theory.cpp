// theory.NAME{...}: the closed forms, documented. What they do is in theory_free_functions.cpp and
// theory_forced_functions.cpp.
#include "api/classes.hpp"
#include "api/theory_arguments.hpp"
#include "api/theory_functions.hpp"
#include "api/theory_options.hpp"
#include "theory/theory_forced.hpp"
#include "theory/theory_free.hpp"

namespace dinal::api {

namespace {

namespace f = theory_functions;
namespace o = theory_options;

constexpr lua::Member theory_module_members[] = {
    {lua::a_function<f::free_response>,
     {"theory.free_response{ OPTIONS } -> theta, velocity",
      "The free motion at the times t, from theta0 (rad) and velocity0 (rad per time unit) at t = 0: exact in all "
      "regimes, and with the dry friction of the system, turns and rest included (t must not be negative then). "
      "Instead of system, omega0 (rad per time unit) and zeta = 0 give a motion without dry friction.",
      "sys = nondimensional{ friction_ratio = 0.167 }\n"
      "print(string.format(\"%.9f %.1f\", theory.free_response{ system = sys, velocity0 = 2*math.pi, t = 5 }))\n"
      "--> 0.155151392 0.0",
      {&o::free_response}}},
    {lua::a_function<f::extremes>,
     {"theory.extremes{ OPTIONS } -> t, theta",
      "When and where the velocity of a free motion is zero, by the half-cycle map: two vectors; "
      "the last place is the place of rest. If the motion starts with velocity 0, the start is "
      "the first one. count is the greatest number of them; it is needed if the motion never "
      "comes to rest.",
      "sys = nondimensional{ friction_ratio = 0.1 }\n"
      "print(theory.extremes{ system = sys, theta0 = 0.55 })  --> vector{ 0, 0.5, 1, 1.5 }\t"
      "vector{ 0.55, -0.35, 0.15, 0.05 }",
      {&o::extremes}}},
    {lua::a_function<f::time_to_rest>,
     {"theory.time_to_rest{ OPTIONS } -> number or vector",
      "When a free motion stops for good (time units); math.huge when it does so never, as without dry friction, or "
      "when it only creeps towards its place, as an overdamped one.",
      "sys = nondimensional{ friction_ratio = 0.167 }\n"
      "print(string.format(\"%.9f\", theory.time_to_rest{ system = sys, velocity0 = 2*math.pi }))  --> 1.723664157",
      {&o::time_to_rest}}},
    {lua::a_function<f::rest_position>,
     {"theory.rest_position{ OPTIONS } -> number or nil, or vector",
      "The place of rest of a free motion, or its limit (rad); nil, or nan in a vector, if it "
      "swings for ever.",
      "sys = nondimensional{ friction_ratio = 0.1 }\n"
      "print(theory.rest_position{ system = sys, theta0 = { 0.05, 0.15, 1.05 } })  --> vector{ 0.05, 0.05, -0.05 }",
      {&o::rest_position}}},
    {lua::a_function<f::half_cycle>,
     {"theory.half_cycle{ OPTIONS } -> number or vector",
      "The extreme of a free motion that is n half cycles after the extreme X (rad, with its "
      "sign): X' = s x_f - (X - s x_f) e^(-pi zeta/sqrt(1 - zeta^2)), s = sgn X, x_f = Rd/k. "
      "Within dead_zone = Re/k the mass stays. Instead of zeta, x_f and dead_zone a system can "
      "be given. zeta < 1.",
      "print(theory.half_cycle{ X = 1, x_f = 0.2 }, theory.half_cycle{ X = 1, x_f = 0.2, n = 9 })  --> -0.6\t0.2",
      {&o::half_cycle}}},
    {lua::a_function<closed_form<o::logarithmic_decrement, theory::logarithmic_decrement>>,
     {"theory.logarithmic_decrement{ OPTIONS } -> number or vector",
      "ln(X0/X2) of extremes a full cycle apart, by viscous damping alone: 2 pi zeta/sqrt(1 - zeta^2), zeta < 1.",
      "print(string.format(\"%.6f\", theory.logarithmic_decrement{ zeta = 0.119 }))  --> 0.753050",
      {&o::logarithmic_decrement}}},
    {lua::a_function<closed_form<o::zeta_from_decrement, theory::zeta_of_decrement>>,
     {"theory.zeta_from_decrement{ OPTIONS } -> number or vector",
      "The viscous damping ratio that has this logarithmic decrement.",
      "print(string.format(\"%.3f\", theory.zeta_from_decrement{ decrement = 0.753050 }))  --> 0.119",
      {&o::zeta_from_decrement}}},
    {lua::a_function<closed_form<o::friction_decrement, theory::friction_decrement>>,
     {"theory.friction_decrement{ OPTIONS } -> number or vector",
      "What dry friction alone takes from the amplitude in each full cycle: 4 Rd/k, rad.",
      "print(theory.friction_decrement{ Rd = 2, k = 40 })  --> 0.2",
      {&o::friction_decrement}}},
    {lua::a_function<closed_form<o::identify, f::identify>>,
     {"theory.identify{ OPTIONS } -> zeta, x_f",
      "Both dampings from three successive extremes of a free motion (signs do not count), rest not among them: q = "
      "(X1 - X2)/(X0 - X1), zeta/sqrt(1 - zeta^2) = -(ln q)/pi, x_f = Rd/k = (q X0 - X1)/(1 + q). nil unless X0 > X1 > "
      "X2. A negative result says that the extremes are too inaccurate to tell this damping from none.",
      "t, X = theory.extremes{ system = nondimensional{ zeta = 0.119, friction_ratio = 0.06 }, theta0 = 1 }\n"
      "print(string.format(\"%.6f %.6f\", theory.identify{ X0 = X[1], X1 = X[2], X2 = X[3] }))"
      "  --> 0.119000 0.060000",
      {&o::identify}}},
    {lua::a_function<closed_form<o::magnification, theory::magnification>>,
     {"theory.magnification{ OPTIONS } -> number or vector",
      "The steady amplitude under M0 sin(omega t) without dry friction, in units of M0/k: 1/sqrt((1 - r^2)^2 + 4 "
      "zeta^2 r^2), r = omega/omega0. math.huge at r = 1 without damping.",
      "print(theory.magnification{ r = { 0, 0.5, 2 } })  --> vector{ 1, 1.33333, 0.333333 }",
      {&o::magnification}}},
    {lua::a_function<closed_form<o::phase_lag, theory::phase_lag>>,
     {"theory.phase_lag{ OPTIONS } -> number or vector",
      "How far that motion is behind its load, rad: atan2(2 zeta r, 1 - r^2), from 0 to pi; pi/2 at r = 1.",
      "print(theory.phase_lag{ r = { 0.5, 1, 2 }, zeta = 0.1 })  --> vector{ 0.132552, 1.5708, 3.00904 }",
      {&o::phase_lag}}},
    {lua::a_function<closed_form<o::transmissibility, theory::transmissibility>>,
     {"theory.transmissibility{ OPTIONS } -> number or vector",
      "The torque that spring and damper pass on to the support over the torque of the load, and as well the motion of "
      "the mass over the motion of its support: sqrt(1 + 4 zeta^2 r^2) times the magnification. Without dry friction.",
      "print(string.format(\"%.12f\", theory.transmissibility{ r = math.sqrt(2), zeta = 0.3 }))  --> 1.000000000000",
      {&o::transmissibility}}},
    {lua::a_function<closed_form<o::equivalent_damping, theory::equivalent_damping>>,
     {"theory.equivalent_damping{ OPTIONS } -> number or vector",
      "The viscous damping constant C that takes from each cycle of this amplitude (rad) as much energy as the dry "
      "friction Rd: 4 Rd/(pi omega amplitude).",
      "print(string.format(\"%.6f\", theory.equivalent_damping{ Rd = 1, omega = 2, amplitude = 0.5 }))  --> 1.273240",
      {&o::equivalent_damping}}},
    {lua::a_function<closed_form<o::equivalent_zeta, theory::equivalent_damping_ratio>>,
     {"theory.equivalent_zeta{ OPTIONS } -> number or vector",
      "The same as a damping ratio: 2 gamma/(pi r Phi), with gamma = Rd/M0 and Phi the amplitude in units of M0/k.",
      "phi = theory.linearised{ r = 1.35, friction_ratio = 0.5 }\n"
      "print(string.format(\"%.4f\", theory.equivalent_zeta{ friction_ratio = 0.5, r = 1.35, magnification = phi }))\n"
      "--> 0.2515",
      {&o::equivalent_zeta}}},
    {lua::a_function<closed_form<o::linearised, f::linearised>>,
     {"theory.linearised{ OPTIONS } -> amplitude, lag",
      "The steady motion with dry friction replaced by its equivalent damping, added to zeta: amplitude in units of "
      "M0/k, sqrt(1 - (4 gamma/pi)^2)/|1 - r^2| for zeta = 0, and lag in rad. For small gamma only; theory.den_hartog "
      "is exact. nil, or nan in a vector, from gamma = pi/4 on.",
      "print(string.format(\"%.4f %.4f\", theory.linearised{ r = 1.35, friction_ratio = 0.5 }))  --> 0.9376 2.4515",
      {&o::linearised}}},
    {lua::a_function<closed_form<o::friction_work, theory::friction_work>>,
     {"theory.friction_work{ OPTIONS } -> number or vector",
      "The energy that dry friction takes in each cycle of this amplitude (rad): 4 Rd amplitude.",
      "print(theory.friction_work{ Rd = 2, amplitude = { 0.5, 1 } })  --> vector{ 4, 8 }",
      {&o::friction_work}}},
    {lua::a_function<closed_form<o::growth_at_resonance, theory::growth_at_resonance>>,
     {"theory.growth_at_resonance{ OPTIONS } -> number or vector",
      "The growth of the amplitude in each period at r = 1 without viscous damping, in M0/k: pi "
      "- 4 gamma, gamma = Rd/M0; 0 from gamma = pi/4 on.",
      "print(string.format(\"%.6f\", theory.growth_at_resonance{ friction_ratio = 0.167 }))  --> 2.473593",
      {&o::growth_at_resonance}}},
    {lua::a_function<f::den_hartog>,
     {"theory.den_hartog{ OPTIONS } -> amplitude, lag",
      "The exact steady motion under M0 sin(omega t) with dry friction and without stops (Den Hartog 1931): amplitude "
      "in units of M0/k and lag of its peak in rad; r = omega/omega0, friction_ratio = Rd/M0, breakaway_ratio = Re/M0. "
      "nil, or nan in a vector, beyond theory.stop_boundary, where the mass stops in each cycle. At r = 1 with "
      "zeta = 0 the motion grows without bound: math.huge and pi/2. At r = 1/2, 1/4, ... with zeta = 0 the steady "
      "motion depends on its start; this is the symmetric one of them. r is 0 or from 0.0001 to 1e6.",
      "print(string.format(\"%.9f %.4f\", theory.den_hartog{ r = 0.75, friction_ratio = 0.5 }))"
      "  --> 1.972601445 0.5296\n"
      "print(theory.den_hartog{ r = { 0.75, 0.75 }, friction_ratio = { 0.7, 0.8 } })\n"
      "--> vector{ 1.61591, nan }\tvector{ 0.785606, nan }",
      {&o::den_hartog}}},
    {lua::a_function<f::den_hartog_fundamental>,
     {"theory.den_hartog_fundamental{ OPTIONS } -> "
      "amplitude, lag",
      "The harmonic part of that motion that has the frequency of the load: its amplitude in "
      "units of M0/k and its lag in rad. A linear theory can at best predict this part.",
      "amplitude, lag = theory.den_hartog_fundamental{ r = 1.35, friction_ratio = 0.5 }\n"
      "print(string.format(\"%.4f, %.2f degrees\", amplitude, math.deg(lag)))  --> 0.8649, 140.69 degrees",
      {&o::den_hartog_fundamental}}},
    {lua::a_function<closed_form<o::stop_boundary, f::stop_boundary>>,
     {"theory.stop_boundary{ OPTIONS } -> number or vector",
      "The friction ratio Rd/M0 up to which the steady motion under M0 sin(omega t) "
      "has no stops; r is 0 or from 0.0001 to 1e6.",
      "print(theory.stop_boundary{ r = { 0.5, 1, 3 } })  --> vector{ 0.333333, 0.785398, 0.5625 }",
      {&o::stop_boundary}}},
    {lua::a_function<f::step_limit>,
     {"theory.step_limit{ OPTIONS } -> number or vector",
      "The greatest step (time units) by one of three rules: \"rk4\", beyond which integrator.rk4 amplifies a free "
      "motion; \"report\", deltatmax of the program of 1989, T0 (zeta + gamma/VMAX) with gamma = Rd/|Mc| and VMAX the "
      "greatest velocity of the free motion, Mc that of a free motion unless given; \"corrected\", what its argument "
      "gives without slips, T0 zeta/pi + Rd/(k VMAX). Only the first one is a limit.",
      "sys = nondimensional{ zeta = 0.02387 }\n"
      "print(string.format(\"%.4f %.4f %.4f\", theory.step_limit{ system = sys },\n"
      "    theory.step_limit{ system = sys, rule = \"report\" }, "
      "theory.step_limit{ system = sys, rule = \"corrected\" }))\n"
      "--> 0.4573 0.0239 0.0076",
      {&o::step_limit}}},
};

}  // namespace

const lua::Class theory_module = {
    "theory",
    {"theory.NAME{ ... } -> numbers or vectors",
     "Closed forms to compare a run with. Each option that is a number can be a vector, or a table of numbers, too: "
     "then the results are vectors (all of them equally long). Where a formula does not hold, the result is nil, and "
     "nan in a vector. docs/theory.md has the formulas. For a system under M0 sin(omega t): r = omega/sys.omega0, "
     "zeta = sys.zeta, friction_ratio = sys:friction_ratio(M0).",
     "r = vector.linspace(0.5, 2, 4)\n"
     "print(theory.magnification{ r = r, zeta = 0.1 })  --> vector{ 1.32164, 5, 0.77791, 0.330409 }"},
    theory_module_members};

void register_theory(lua_State* L) {
    lua::add_module(L, theory_module);
}

}  // namespace dinal::api
