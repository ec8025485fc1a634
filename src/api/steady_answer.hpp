// The options of sys:steady{ ... }, and its answer in Lua.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "analysis/returns.hpp"
#include "analysis/steady.hpp"
#include "api/bodies.hpp"
#include "api/drive_options.hpp"
#include "api/system_options.hpp"
#include "lua/interrupt.hpp"
#include "lua/options.hpp"
#include "lua/user_function.hpp"
#include "lua/values.hpp"

namespace dinal::api {

/// A period, given in one of three ways.
struct PeriodOptions {
    std::optional<double> period = {}, frequency = {}, omega = {};
};
constexpr text::Option period_row(const char* meaning, const char* otherwise = text::its_own) {
    return text::option<&PeriodOptions::period>(
        "period", meaning, {.unit = "time units", .otherwise = otherwise, .range = text::positive});
}
inline constexpr text::Option instead_of_period[] = {
    text::option<&PeriodOptions::frequency>("frequency", "1/period, instead of period",
                                            {.unit = "cycles per time unit", .range = text::positive}),
    text::option<&PeriodOptions::omega>("omega", "2 pi/period, instead of period",
                                        {.unit = "rad per time unit", .range = text::positive}),
};
/// The period given by the options. Raises an error if more than one is given.
std::optional<double> asked_period(const lua::Options& options);

/// The options other than the drive.
struct SteadyOptions {
    std::optional<int> periods = {};
};
inline constexpr text::Range whole_periods{"be a whole number from 1 to 1000",
                                           [](double x) { return text::is_whole(x, 1, 1000); }};
inline constexpr text::Option period_options[] = {
    period_row(
        "the period of M, belt and base, needed if one of them is a Lua function of t whose period is not found; the "
        "period of a limit cycle is found"),
    instead_of_period[0],
    instead_of_period[1],
    text::option<&SteadyOptions::periods>(
        "periods",
        "periods of M in one of the motion, for a subharmonic one; by default as many as are found, up to 32",
        {.range = whole_periods}),
};
inline constexpr auto steady_options = text::joined(drive_options, period_options, more_drive_options);
inline constexpr text::Call steady_call{"sys:steady", "sys:steady{ M = excitation.harmonic{ frequency = 0.4 } }",
                                        steady_options, false, &with_call};
inline constexpr text::Call steady_run_call{"run:steady", "run:steady{ period = 2.5 }", period_options, true};

struct Steady {
    analysis::SteadyQuestion question;
    analysis::SteadyMotion motion;
    std::optional<analysis::SteadyShape> shape = {};  ///< computed on first use
    /// The other motions of all bodies, once they have been searched.
    std::optional<std::vector<std::shared_ptr<Steady>>> others = {};
    RunHandle run = {};                  ///< one period of a motion that is not plain; null at rest
    std::shared_ptr<Steady> whole = {};  ///< the motion of all bodies, if this is one body or link

    bool of_all() const { return !question.is_plain() && whole == nullptr; }
};
// Shared: a user's function may drop the last reference meanwhile.
using SteadyHandle = std::shared_ptr<Steady>;

inline bool is_found(const Steady& s) {
    return s.motion.is_found();
}

inline double greatest_angle(const analysis::SteadyMotion& motion) {
    return std::max(std::fabs(motion.low), std::fabs(motion.high));
}

/// Calls `work`, which may evaluate user functions, and raises their errors.
template <class Work>
void call_checked(lua_State* L, Work work) {
    lua::CallState call(L);
    work([](double) { return !lua::interrupt_requested(); });
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    call.check();
}
/// The same for functions that receive the motion of the question.
template <class Work>
void call_checked(lua_State* L, const analysis::SteadyQuestion& question, Work work) {
    lua::CallState call(L);
    name_functions(call, *question.system, question.drive);
    work([](double) { return !lua::interrupt_requested(); });
    if (lua::interrupt_requested()) lua::raise_interrupted(L);
    call.check();
}

/// The common repetition of the drive, as declared by its terms or given by the user; period 0 if nothing depends on t.
/// Raises an error if the period is unknown or wrong.
analysis::Repetition repetition_or_fail(lua_State* L, const lua::Options& options,
                                        const analysis::SteadyQuestion& question, const std::optional<double>& period);

/// Raises an error if the motion could not be followed, or M contradicted itself.
void check_motion(const lua::Options& options, const analysis::SteadyMotion& motion);

/// sys:steady{ ... } and run:steady{ ... }
int steady_of_system(lua_State* L);
int steady_of_run(lua_State* L);
/// s.run
lua::Pushed run_of_steady(lua_State* L, const SteadyHandle& s);

/// The time after which its controllers repeat; raises an error if there is none.
double settles_or_fail(const lua::Options& options, const analysis::SteadyQuestion& question);

inline constexpr lua::Doc steady_doc{
    "sys:steady{ OPTIONS } -> steady",
    "The motion that remains when transients have died out: periodic under a periodic M, belt or base; a limit "
    "cycle, whose period is found, or rest if nothing depends on t. theta0 and velocity0 start the search, and select "
    "one of several motions. Of named bodies s.load is the motion of the body or link `load`: amplitude, mean, lag, stops, "
    "run; angles of those that go round are measured from each other.",
    "sys = nondimensional{ friction_ratio = 0.5 }\n"
    "s = sys:steady{ M = excitation.harmonic{ frequency = 1.35 } }\n"
    "print(string.format(\"%.9f\", s.amplitude), s.stops)  --> 0.860792180\t0\n"
    "squeal = system{ I = 1, k = 4, Rd = 0.3, Re = 0.6 }:steady{ belt = 0.1 }\n"
    "print(string.format(\"%.6f\", squeal.period), squeal.stops)  --> 3.658799\t1\n"
    "rig = system{ bodies = { a = { I = 1, k = 4, Rd = 0.3, Re = 0.6 }, b = { I = 0.5, C = 0.05 } },\n"
    "    links = { rod = { \"a\", \"b\", k = 2, C = 0.1 } } }\n"
    "s = rig:steady{ belt = { a = 0.1 }, theta0 = { a = 0.3 } }\n"
    "print(s.status, string.format(\"%.6f %.6f\", s.period, s.b.amplitude))  --> steady\t4.627741 0.114468",
    {&steady_call}};
inline constexpr lua::Doc steady_run_doc{
    "run:steady{ OPTIONS } -> steady",
    "The steady motion that this run leads to: sys:steady with the options and from the end of the run.",
    "sys = nondimensional{ friction_ratio = 0.836 }\n"
    "run = sys:simulate{ M = excitation.harmonic{ frequency = 1 }, theta0 = 1, t_end = 5, dt = 1 }\n"
    "s = run:steady()\n"
    "print(string.format(\"%.9f\", s.amplitude), s.stops)  --> 0.129170352\t2",
    {&steady_run_call}};

}  // namespace dinal::api
