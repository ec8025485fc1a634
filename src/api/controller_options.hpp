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
     .meaning = "sampling interval",
     .filled = text::fills<&model::SampledController::every>},
    {.name = "delay",
     .unit = "time units",
     .range = text::not_negative,
     .meaning = "time from sampling to output",
     .filled = text::fills<&model::SampledController::delay>},
    {.name = "at",
     .unit = "time units",
     .meaning = "the first sampling time; those before the start of a run are left out",
     .filled = text::fills<&model::SampledController::at>},
    {.name = "start",
     .meaning =
         "a function that returns the memory of a run, a table, which f gets as its fifth argument and may change",
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
     .meaning = "the torque while on, its opposite while off; or both torques { on, off }",
     .wanted = "a number, or two: { on, off }"},
    {.name = "of",
     .otherwise = "\"theta\"",
     .meaning =
         "the observed quantity: \"theta\", \"velocity\", the name of a state, or a function of t, theta, velocity, z",
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
      "A sampled controller: f(t, theta, velocity, z, memory) is called once at each sampling time, in order. Its "
      "result is held until the next; before the first one M is 0. Each run gets a new memory, the table that "
      "start returns, so runs can be repeated, continued and swept. z is nil without states. It has values only in "
      "a run.",
      "M = excitation.sampled(function(t, theta, velocity, z, memory)\n"
      "  memory.e = memory.e + 0.1*(1 - theta)\n"
      "  return 5*memory.e - 3*velocity\n"
      "end, { every = 0.1, start = function() return { e = 0 } end })\n"
      "run = nondimensional{}:simulate{ M = M, t_end = 1, dt = 0.25 }\n"
      "print(run.M[1], run.M[2] == run.M[3])  --> 0.5\tfalse",
      {&sampled_call}}},
    {lua::a_function<relay_controller>,
     {"excitation.relay{ OPTIONS } -> excitation",
      "A switch with hysteresis: M is amplitude after the quantity has passed `on`, and -amplitude after it has "
      "passed `off`. Each switch is located, and is an event of kind \"switch\". It has values only in a run.",
      "M = excitation.relay{ on = -0.1, off = 0.1, amplitude = 1 }\n"
      "run = nondimensional{ zeta = 0.1 }:simulate{ M = M, t_end = 1, dt = 0.5 }\n"
      "print(run.events[1].kind, string.format(\"%.6f\", run.events[1].theta))  --> switch\t0.100000",
      {&relay_call}}},
    {lua::a_function<delayed_controller>,
     {"excitation.delayed(f, { OPTIONS }) -> excitation",
      "A controller with a dead time: f(t, theta, velocity) gets the present t, and theta and velocity of the time "
      "t - by; before the start of the run these are the initial ones. It has values only in a run.",
      "M = excitation.delayed(function(t, theta, velocity) return -0.1*velocity end, { by = 0.02 })\n"
      "run = nondimensional{}:simulate{ M = M, velocity0 = 1, t_end = 1, dt = 0.01 }\n"
      "print(run.M[1], run.M[2])  --> -0.1\t-0.1",
      {&delayed_call}}},
};

}  // namespace dinal::api
