// sys:simulate{...}: a method of the class in bind_system.cpp, with a file of its own for its many options.
#pragma once

#include <functional>

#include "lua/bind.hpp"
#include "lua/options.hpp"
#include "motion/simulate.hpp"
#include "source/origin.hpp"

namespace dinal::api {

int simulate_system(lua_State* L);

/// What is asked of the core: simulate() or resume().
using Compute = std::function<text::Expected<motion::Trajectory>(
    const source::Task& task, const motion::Monitor& monitor, const motion::Limits& limits)>;

/// Pushes the run that `compute` makes of the task of `origin`, beginning at the time `from`: under the limits of the
/// script, with a progress line. Raises when the core refuses the task, M fails or Ctrl-C is pressed; what was done
/// until then is in dinal.partial.
int run_task(lua_State* L, const lua::Options& options, source::Origin origin, double from, bool dense,
             const Compute& compute);

inline constexpr lua::Doc simulate_doc = {
    "sys:simulate{ M = 0, theta0 = 0, velocity0 = 0, t_start = 0, t_end, dt | times, integrator, dense = true } -> run",
    "Runs the system from theta0 (rad) and velocity0 (rad per time unit) at t_start to t_end. M is the excitation: a "
    "number, a Lua function of t or of t, theta, velocity, or an excitation. Rows are kept every dt and at t_end, or "
    "at `times` (a table or a vector, increasing; t_end is then the last of them unless given; {} keeps no rows). The "
    "integrator is integrator.spectral{} unless given. dense = false keeps nothing between the rows, which saves "
    "memory in very long runs and costs run:at(t). "
    "When M fails or Ctrl-C is pressed, what was done so far is in dinal.partial.",
    "sys = nondimensional{ friction_ratio = 0.167 }\n"
    "run = sys:simulate{ theta0 = 0, velocity0 = 2*math.pi, t_end = 3, dt = 0.01 }\n"
    "print(run.outcome, string.format(\"%.6f\", run:at(3)))  --> at rest\t0.155151"};

}  // namespace dinal::api
