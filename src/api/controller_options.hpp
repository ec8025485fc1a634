// The options of excitation.sampled, relay and delayed.
#pragma once

#include <vector>

#include "lua/bind.hpp"
#include "model/controller.hpp"
#include "text/option.hpp"

namespace dinal::api {

inline constexpr text::Option sampled_options[] = {
    {.name = "every",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "from one instant to the next",
     .filled = text::fills<&model::SampledController::every>},
    {.name = "delay",
     .unit = "time units",
     .range = text::not_negative,
     .meaning = "delay from an instant to the effect of its output",
     .filled = text::fills<&model::SampledController::delay>},
    {.name = "at",
     .unit = "time units",
     .meaning = "the first instant; those before the start of a run are left out",
     .filled = text::fills<&model::SampledController::at>},
    {.name = "start",
     .meaning = "returns the memory of a run, a table, which f gets as its fifth argument and may change",
     .wanted = "a function that returns a table, such as function() return { e = 0 } end"},
};
inline constexpr text::Call sampled_call{
    "excitation.sampled",
    "excitation.sampled(function(t, theta, velocity) return -theta end, { every = 0.01 })",
    sampled_options,
    false,
    nullptr,
    "every"};

inline constexpr text::Option delayed_options[] = {
    {.name = "by",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "age of theta and velocity",
     .filled = text::fills<&model::DelayedController::by>},
};
inline constexpr text::Call delayed_call{
    "excitation.delayed",
    "excitation.delayed(function(t, theta, velocity) return -theta end, { by = 0.02 })",
    delayed_options,
    false,
    nullptr,
    "by"};

struct RelayOptions {
    enum class Start { on, off };
    double on = 0, off = 0;
    Start start = Start::on;
};
inline constexpr const char* relay_starts[] = {"on", "off"};
inline constexpr text::Option relay_options[] = {
    {.name = "on",
     .otherwise = text::needed,
     .meaning = "threshold at which it switches on",
     .filled = text::fills<&RelayOptions::on>},
    {.name = "off",
     .otherwise = text::needed,
     .meaning = "threshold at which it switches off",
     .filled = text::fills<&RelayOptions::off>},
    {.name = "amplitude",
     .unit = "torque",
     .otherwise = text::needed,
     .meaning = "the torque while it is on, and its opposite while it is off; or the two torques { on, off }",
     .wanted = "a number, or two: { on, off }"},
    {.name = "of",
     .otherwise = "\"theta\"",
     .meaning = "the quantity that it watches: \"theta\", \"velocity\", the name of a state, or a function "
                "of t, theta, velocity, z",
     .wanted = "\"theta\", \"velocity\", the name of a state or a function"},
    {.name = "start",
     .meaning = "initial state, if the start is between the thresholds",
     .filled = text::fills<&RelayOptions::start>,
     .choices = relay_starts},
};
inline constexpr text::Call relay_call{"excitation.relay", "excitation.relay{ on = 0.25, off = 0.35, amplitude = 0.2 }",
                                       relay_options};

int sampled_controller(lua_State* L);
int relay_controller(lua_State* L);
int delayed_controller(lua_State* L);

inline constexpr lua::Member controller_functions[] = {
    {lua::a_function<sampled_controller>,
     {"excitation.sampled(f, { OPTIONS }) -> excitation",
      "A controller that samples: f(t, theta, velocity, z, memory) is called once at each instant, in order. What it "
      "returns is held until the next instant; before the first one M is 0. A memory is a table that start returns: "
      "each run gets a new one, and a run that is continued goes on with its own, so that runs can be repeated, "
      "continued and swept. z is nil without states. It has values in a run only.",
      "M = excitation.sampled(function(t, theta, velocity, z, memory)\n"
      "  memory.e = memory.e + 0.1*(1 - theta)\n"
      "  return 5*memory.e - 3*velocity\n"
      "end, { every = 0.1, start = function() return { e = 0 } end })\n"
      "run = nondimensional{}:simulate{ M = M, t_end = 1, dt = 0.25 }\n"
      "print(run.M[1], run.M[2] == run.M[3])  --> 0.5\tfalse",
      {&sampled_call}}},
    {lua::a_function<relay_controller>,
     {"excitation.relay{ OPTIONS } -> excitation",
      "A switch with hysteresis: it gives amplitude from where it passes on, coming from the side of off, and -amplitude "
      "from where it passes off, coming from the side of on. Each switch is located, and an event of the kind \"switch\". It has values in a run only.",
      "M = excitation.relay{ on = -0.1, off = 0.1, amplitude = 1 }\n"
      "run = nondimensional{ zeta = 0.1 }:simulate{ M = M, t_end = 1, dt = 0.5 }\n"
      "print(run.events[1].kind, string.format(\"%.6f\", run.events[1].theta))  --> switch\t0.100000",
      {&relay_call}}},
    {lua::a_function<delayed_controller>,
     {"excitation.delayed(f, { OPTIONS }) -> excitation",
      "A controller with a dead time: f(t, theta, velocity) with the present t, and theta and velocity as they were "
      "`by` ago; before the start of the run these are the initial ones. It has values in a run only.",
      "M = excitation.delayed(function(t, theta, velocity) return -0.1*velocity end, { by = 0.02 })\n"
      "run = nondimensional{}:simulate{ M = M, velocity0 = 1, t_end = 1, dt = 0.01 }\n"
      "print(run.M[1], run.M[2])  --> -0.1\t-0.1",
      {&delayed_call}}},
};

}  // namespace dinal::api
