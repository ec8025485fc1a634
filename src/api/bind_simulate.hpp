// sys:simulate{...}: a method of the class in bind_system.cpp, in its own file because of its many options.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "api/drive_options.hpp"
#include "api/system_options.hpp"
#include "lua/bind.hpp"
#include "lua/options.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "source/origin.hpp"
#include "text/words.hpp"

namespace dinal::api {

int simulate_system(lua_State* L);

/// The core function to be called: simulate() or resume().
using Compute = std::function<text::Expected<motion::Run>(const source::Task& task, const motion::Monitor& monitor,
                                                          const motion::Limits& limits)>;

/// Pushes the run that `compute` makes from the task of `origin` from the time `from`: within the script's limits, with
/// a progress line. Raises an error if the core refuses the task, M fails or Ctrl-C is pressed; dinal.partial then has
/// the partial run.
int run_task(lua_State* L, const lua::Options& options, source::Origin origin, double from, bool dense,
             const Compute& compute);

/// Refuses sampled controllers in M that still have the memory of an earlier run. Returns a function to be called with
/// the address of the finished run. `goes_on` says whether the run continues another one.
std::function<void(const void*)> watched_memories(lua_State* L, const lua::Options& options, const model::Excitation& M,
                                                  bool goes_on);

/// The options of sys:simulate other than drive and integrator.
struct RunOptions {
    double t_start = 0;
    std::optional<double> t_end = {};
    std::optional<double> dt = {};
    std::vector<double> times = {};
    bool dense = true;
};
inline constexpr text::FixedText<240> integrator_meaning{"the method; by default ", motion::default_integrator.c_str(),
                                                         ". exact and dinal1989 take one body with constant friction"};
inline constexpr text::Option window_options[] = {
    text::option<&RunOptions::t_start>("t_start", "initial time", {.unit = "time units"}),
    text::option<&RunOptions::t_end>("t_end", "end of the run; by default the last of the times",
                                     {.unit = "time units"}),
    {"dt", "time units", "T0/40", text::positive,
     "time between rows; t_end has a row as well. The default is a fortieth of the natural period (the shortest of "
     "several bodies), but gives at least 1000 rows and at most 100000; without k it gives 1000",
     text::fills<&RunOptions::dt>},
    text::option<&RunOptions::times>("times", "times of the rows: a table or a vector, increasing; {} keeps no rows",
                                     {.unit = "time units", .instead_of_previous = true}),
};
inline constexpr text::Option integrator_option[] = {
    {.name = "integrator",
     .otherwise = "exact or spectral",
     .meaning = integrator_meaning.c_str(),
     .object = "integrator",
     .wanted = "an integrator such as integrator.rk4{ h = 0.001 }"},
};
inline constexpr text::Option dense_option[] = {
    text::option<&RunOptions::dense>("dense", "false keeps only the rows: saves memory, but run:at(t) does not work"),
};
inline constexpr auto simulate_options = text::joined(drive_options, window_options, integrator_option, dense_option,
                                                      more_drive_options, model::units_option);
inline constexpr text::Call simulate_call{"sys:simulate", "sys:simulate{ M = M, theta0 = 1, t_end = 20, dt = 0.01 }",
                                          simulate_options, false, &with_call};

/// The options of run:continue.
struct MoreTime {
    std::optional<double> t_end = {};
    std::optional<std::vector<double>> times = {};
};
inline constexpr text::Option continue_options[] = {
    text::option<&MoreTime::t_end>(
        "t_end", "new end time; by default the last of the times, or the former t_end if the run was stopped before it",
        {.unit = "time units"}),
    text::option<&MoreTime::times>("times", "further times of rows, for a run with times", {.unit = "time units"}),
};
inline constexpr text::Call continue_call{
    "run:continue", "run:continue{ t_end = 40 }", continue_options, true, &simulate_call, "t_end"};

inline constexpr text::FixedText<760> simulate_summary{
    "Runs the system. The default integrator is ", motion::default_integrator.c_str(),
    ", which decides all sticking contacts together. With states, M is called with (t, theta, velocity, z), and "
    "their columns are run.states.NAME. M must depend only on its arguments, because it is evaluated out of order "
    "and repeatedly; a run that detects a memory ends with a message. Put memory into states or excitation.sampled, "
    "relay or delayed, and random numbers into a table. If M fails or Ctrl-C is pressed, dinal.partial has the run so "
    "far."};
inline constexpr lua::Doc simulate_doc = {
    "sys:simulate{ OPTIONS } -> run",
    simulate_summary.c_str(),
    "sys = nondimensional{ friction_ratio = 0.167 }\n"
    "run = sys:simulate{ theta0 = 0, velocity0 = 2*math.pi, t_end = 3, dt = 0.01 }\n"
    "print(run.outcome, string.format(\"%.6f\", run:at(3)))  --> at rest\t0.155151\n"
    "rig = system{ bodies = { motor = { I = 1 }, load = { I = 3, Rd = 0.2 } },\n"
    "    links = { clutch = { \"motor\", \"load\", Rd = 2 } } }\n"
    "run = rig:simulate{ velocity0 = { motor = 3 }, t_end = 10 }\n"
    "print(string.format(\"%.6f\", run.events[1].t), run.events[1].kind, run.events[1].where)  --> "
    "1.153846\tstick\tclutch",
    {&simulate_call}};

}  // namespace dinal::api
