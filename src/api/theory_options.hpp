// The options of theory.NAME{...}: one row each, and the calls that take them.
#pragma once

#include <cmath>
#include <optional>

#include "text/option.hpp"
#include "theory/den_hartog.hpp"

namespace dinal::api::theory_options {

using text::Call;
using text::needed;
using text::Option;
using text::Range;

inline constexpr Range swinging{"be from 0 to less than 1: without a swing there is no next extreme",
                                [](double x) { return x >= 0 && x < 1; }};
inline constexpr Range whole{"be a whole number, 0 or more",
                             [](double x) { return x >= 0 && x == std::floor(x) && std::isfinite(x); }};
inline constexpr Range at_most_ten_million{"be a whole number from 0 to 1e+07",
                                           [](double x) { return text::is_whole(x, 0, 1e7); }};
inline constexpr Range den_hartog_r{
    "be 0 or from 0.0001 to 1e6",
    [](double x) { return x == 0 || (x >= theory::DenHartog::slowest && x <= theory::DenHartog::fastest); }};
inline constexpr Range at_least_one{"be at least 1: breakaway takes no less than kinetic friction",
                                    [](double x) { return x >= 1; }};

// Of most functions; each is a number or a vector.
inline constexpr Option r{.name = "r", .otherwise = needed, .range = text::not_negative, .meaning = "omega/omega0"};
inline constexpr Option sliding_r{.name = "r", .otherwise = needed, .range = den_hartog_r, .meaning = "omega/omega0"};
inline constexpr Option zeta{"zeta", "", "0", text::not_negative, "viscous damping ratio"};
inline constexpr Option friction_ratio{"friction_ratio", "", needed, text::not_negative, "Rd/M0"};
inline constexpr Option breakaway_ratio{"breakaway_ratio", "", "friction_ratio", text::not_negative, "Re/M0"};
inline constexpr Option Rd{"Rd", "torque", needed, text::not_negative, "dry friction while moving"};
inline constexpr Option theta0{"theta0", "rad", "0", text::any_finite, "initial angle"};
inline constexpr Option velocity0{"velocity0", "rad per time unit", "0", text::any_finite, "initial velocity"};
inline constexpr const char* a_system = "a system such as system{ I = 1, k = 39.5 }";
inline constexpr Option system{
    .name = "system", .otherwise = needed, .meaning = "what moves", .object = "system", .wanted = a_system};

inline constexpr Option free_response_options[] = {
    {"t", "time units", needed, text::any_finite, "when; not negative with dry friction"},
    theta0,
    velocity0,
    {.name = "system", .meaning = "what moves", .object = "system", .wanted = a_system},
    {"omega0", "rad per time unit", text::its_own, text::positive, "with zeta, instead of a system"},
    zeta};
inline constexpr Call free_response{"theory.free_response",
                                    "theory.free_response{ system = sys, theta0 = 1, t = vector.linspace(0, 5, 501) }",
                                    free_response_options};

struct ExtremesOptions {
    double theta0 = 0;
    double velocity0 = 0;
    std::optional<double> count = {};
};
inline constexpr Option extremes_options[] = {
    system,
    {"theta0", "rad", "0", text::any_finite, theta0.meaning, text::fills<&ExtremesOptions::theta0>},
    {"velocity0", velocity0.unit, "0", text::any_finite, velocity0.meaning, text::fills<&ExtremesOptions::velocity0>},
    {"count", "", text::its_own, at_most_ten_million,
     "greatest number of extremes; needed if the motion never comes to rest", text::fills<&ExtremesOptions::count>}};
inline constexpr Call extremes{"theory.extremes", "theory.extremes{ system = sys, theta0 = 1 }", extremes_options};

inline constexpr Option start_options[] = {system, theta0, velocity0};
inline constexpr Call time_to_rest{"theory.time_to_rest", "theory.time_to_rest{ system = sys, theta0 = 1 }",
                                   start_options};
inline constexpr Call rest_position{"theory.rest_position", "theory.rest_position{ system = sys, theta0 = 1 }",
                                    start_options};

inline constexpr Option half_cycle_options[] = {
    {"X", "rad", needed, text::any_finite, "an extreme, with its sign"},
    {"zeta", "", "0", swinging, zeta.meaning},
    {"x_f", "rad", "0", text::not_negative, "Rd/k"},
    {"dead_zone", "rad", "x_f", text::not_negative, "Re/k, within which the mass stays"},
    {.name = "system", .meaning = "instead of zeta, x_f and dead_zone", .object = "system", .wanted = a_system},
    {"n", "half cycles", "1", whole, "number of half cycles after X"}};
inline constexpr Call half_cycle{"theory.half_cycle", "theory.half_cycle{ X = 1, zeta = 0.1, x_f = 0.05 }",
                                 half_cycle_options};

inline constexpr Option logarithmic_decrement_options[] = {{"zeta", "", needed, swinging, zeta.meaning}};
inline constexpr Call logarithmic_decrement{
    "theory.logarithmic_decrement", "theory.logarithmic_decrement{ zeta = 0.1 }", logarithmic_decrement_options};

inline constexpr Option zeta_from_decrement_options[] = {
    {"decrement", "", needed, text::not_negative, "ln(X0/X2) of extremes a full cycle apart"}};
inline constexpr Call zeta_from_decrement{"theory.zeta_from_decrement", "theory.zeta_from_decrement{ decrement = 0.3 }",
                                          zeta_from_decrement_options};

inline constexpr Option friction_decrement_options[] = {Rd,
                                                        {"k", "torque per rad", needed, text::positive, "stiffness"}};
inline constexpr Call friction_decrement{"theory.friction_decrement", "theory.friction_decrement{ Rd = 2, k = 40 }",
                                         friction_decrement_options};

inline constexpr Option identify_options[] = {{"X0", "rad", needed, text::not_zero, "an extreme"},
                                              {"X1", "rad", needed, text::any_finite, "the next one"},
                                              {"X2", "rad", needed, text::any_finite, "the one after that"}};
inline constexpr Call identify{"theory.identify", "theory.identify{ X0 = 1, X1 = -0.7, X2 = 0.45 }", identify_options};

inline constexpr Option r_and_zeta[] = {r, zeta};
inline constexpr Call magnification{"theory.magnification", "theory.magnification{ r = 0.5, zeta = 0.1 }", r_and_zeta};
inline constexpr Call phase_lag{"theory.phase_lag", "theory.phase_lag{ r = 0.5, zeta = 0.1 }", r_and_zeta};
inline constexpr Call transmissibility{"theory.transmissibility", "theory.transmissibility{ r = 0.5, zeta = 0.1 }",
                                       r_and_zeta};

inline constexpr Option equivalent_damping_options[] = {
    Rd,
    {"omega", "rad per time unit", needed, text::positive, "of the motion"},
    {"amplitude", "rad", needed, text::positive, "of the motion"}};
inline constexpr Call equivalent_damping{"theory.equivalent_damping",
                                         "theory.equivalent_damping{ Rd = 2, omega = 6.28, amplitude = 0.5 }",
                                         equivalent_damping_options};

inline constexpr Option equivalent_zeta_options[] = {
    friction_ratio,
    {"r", "", needed, text::positive, r.meaning},
    {"magnification", "", needed, text::positive, "the amplitude in units of M0/k"}};
inline constexpr Call equivalent_zeta{"theory.equivalent_zeta",
                                      "theory.equivalent_zeta{ friction_ratio = 0.2, r = 0.5, magnification = 1.3 }",
                                      equivalent_zeta_options};

inline constexpr Option linearised_options[] = {r, friction_ratio, zeta};
inline constexpr Call linearised{"theory.linearised", "theory.linearised{ r = 0.5, friction_ratio = 0.1 }",
                                 linearised_options};

inline constexpr Option friction_work_options[] = {Rd,
                                                   {"amplitude", "rad", needed, text::not_negative, "of the motion"}};
inline constexpr Call friction_work{"theory.friction_work", "theory.friction_work{ Rd = 2, amplitude = 0.5 }",
                                    friction_work_options};

inline constexpr Option growth_options[] = {friction_ratio};
inline constexpr Call growth_at_resonance{"theory.growth_at_resonance",
                                          "theory.growth_at_resonance{ friction_ratio = 0.2 }", growth_options};

inline constexpr Option den_hartog_options[] = {sliding_r, friction_ratio, zeta, breakaway_ratio};
inline constexpr Call den_hartog{"theory.den_hartog", "theory.den_hartog{ r = 0.75, friction_ratio = 0.5 }",
                                 den_hartog_options};
inline constexpr Call den_hartog_fundamental{"theory.den_hartog_fundamental",
                                             "theory.den_hartog_fundamental{ r = 0.75, friction_ratio = 0.5 }",
                                             den_hartog_options};

inline constexpr Option stop_boundary_options[] = {
    sliding_r, zeta, {"Re_over_Rd", "", "1", at_least_one, "breakaway over kinetic friction"}};
inline constexpr Call stop_boundary{"theory.stop_boundary", "theory.stop_boundary{ r = 0.75, zeta = 0.1 }",
                                    stop_boundary_options};

struct StepRule {
    enum class Name { rk4, report, corrected };
    Name rule = Name::rk4;
};
inline constexpr const char* rule_names[] = {"rk4", "report", "corrected"};
inline constexpr Option step_limit_options[] = {
    system,
    {.name = "rule", .meaning = "which of the three", .filled = text::fills<&StepRule::rule>, .choices = rule_names},
    theta0,
    velocity0,
    {"Mc", "torque", text::its_own, text::not_zero, "characteristic torque; by default that of the free motion"}};
inline constexpr Call step_limit{"theory.step_limit", "theory.step_limit{ system = sys, rule = \"rk4\" }",
                                 step_limit_options};

}  // namespace dinal::api::theory_options
