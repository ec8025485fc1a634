// What `excitation.` has to offer, with its documentation; the functions are in excitation_terms.cpp (numbers) and
// excitation_data.cpp (tables, files, functions).
#include "api/bind_excitation.hpp"
#include "api/classes.hpp"

namespace dinal::api {
namespace {

constexpr lua::Member excitation_module_members[] = {
    {"constant",
     lua::guarded<excitation_functions::constant>,
     lua::Kind::function,
     {"excitation.constant{ level } -> excitation", "The same torque at all times.",
      "print(excitation.constant{ level = 2 }(10))  --> 2.0"}},
    {"harmonic",
     lua::guarded<excitation_functions::harmonic>,
     lua::Kind::function,
     {"excitation.harmonic{ amplitude = 1, frequency | omega, phase = 0 } -> excitation",
      "amplitude sin(omega t + phase). Give frequency (cycles per time unit) "
      "or omega (rad per time unit); phase is in rad.",
      "print(excitation.harmonic{ amplitude = 3, frequency = 0.25 }(1))  --> 3.0"}},
    {"step",
     lua::guarded<excitation_functions::step>,
     lua::Kind::function,
     {"excitation.step{ level = 1, at = 0 } -> excitation", "0 before the time `at`, level from then on.",
      "M = excitation.step{ level = 2, at = 1 }\nprint(M(0.9), M(1))  --> 0.0\t2.0"}},
    {"pulse",
     lua::guarded<excitation_functions::pulse>,
     lua::Kind::function,
     {"excitation.pulse{ amplitude = 1, at = 0, width } -> excitation",
      "amplitude for at <= t < at + width, else 0. Pulses add up to a train.",
      "M = excitation.pulse{ at = 1, width = 0.5 } + excitation.pulse{ at = 3, width = 0.5 }\n"
      "print(M(1.2), M(2), M(3.2))  --> 1.0\t0.0\t1.0"}},
    {"half_sine",
     lua::guarded<excitation_functions::half_sine>,
     lua::Kind::function,
     {"excitation.half_sine{ amplitude = 1, at = 0, width } -> excitation",
      "One half wave of a sine from `at` to at + width, else 0: a shock.",
      "print(excitation.half_sine{ amplitude = 3, width = 2 }(1))  --> 3.0"}},
    {"gaussian",
     lua::guarded<excitation_functions::gaussian>,
     lua::Kind::function,
     {"excitation.gaussian{ amplitude = 1, at = 0, width } -> excitation", model::Gaussian::about.summary,
      model::Gaussian::about.example}},
    {"ramp",
     lua::guarded<excitation_functions::ramp>,
     lua::Kind::function,
     {"excitation.ramp{ slope = 1, at = 0, width = math.huge } -> excitation",
      "0 before `at`, then rising by slope per time unit; constant again after width.",
      "M = excitation.ramp{ slope = 2, at = 1, width = 3 }\nprint(M(0), M(2), M(9))  --> 0.0\t2.0\t6.0"}},
    {"square",
     lua::guarded<excitation_functions::square>,
     lua::Kind::function,
     {"excitation.square{ amplitude = 1, period | frequency, duty = 0.5, at = 0 } -> excitation",
      "+amplitude for the first part `duty` of each period, -amplitude for the rest. A period begins at `at`.",
      "M = excitation.square{ period = 4, duty = 0.25 }\nprint(M(0), M(0.9), M(1))  --> 1.0\t1.0\t-1.0"}},
    {"sawtooth",
     lua::guarded<excitation_functions::sawtooth>,
     lua::Kind::function,
     {"excitation.sawtooth{ amplitude = 1, period | frequency, at = 0 } -> excitation",
      "Rises from -amplitude to amplitude over each period and drops back. A period begins at `at`.",
      "M = excitation.sawtooth{ period = 2 }\nprint(M(0), M(1), M(1.5))  --> -1.0\t0.0\t0.5"}},
    {"triangle",
     lua::guarded<excitation_functions::triangle>,
     lua::Kind::function,
     {"excitation.triangle{ amplitude = 1, period | frequency, at = 0 } -> excitation",
      "The corners of a sine joined by straight lines: 0, amplitude, 0, -amplitude. A period begins at `at`.",
      "M = excitation.triangle{ period = 4 }\nprint(M(0.5), M(1), M(3))  --> 0.5\t1.0\t-1.0"}},
    {"chirp",
     lua::guarded<excitation_functions::chirp>,
     lua::Kind::function,
     {"excitation.chirp{ amplitude = 1, from, to, duration, at = 0, phase = 0 } -> excitation",
      "A sine whose frequency goes evenly from `from` to `to` (cycles per time unit) over `duration`, beginning at "
      "`at` with sin(phase). It keeps the first frequency before that and the last one after it.",
      "print(excitation.chirp{ from = 0, to = 1, duration = 2 }(1))  --> 1.0"}},
    {"exponential",
     lua::guarded<excitation_functions::exponential>,
     lua::Kind::function,
     {"excitation.exponential{ amplitude = 1, tau, at = 0 } -> excitation",
      "amplitude exp(-(t - at)/tau) from `at` on, 0 before. A negative tau grows.",
      "M = excitation.exponential{ amplitude = 2, tau = 0.5, at = 1 }\nprint(M(0.9), M(1))  --> 0.0\t2.0"}},
    {"polynomial",
     lua::guarded<excitation_functions::polynomial>,
     lua::Kind::function,
     {"excitation.polynomial{ coefficients, at = 0 } -> excitation",
      "c[1] + c[2] (t - at) + c[3] (t - at)^2 + ... at all times; cut a piece out with e:window.",
      "print(excitation.polynomial{ coefficients = { 1, 0, 2 } }(3))  --> 19.0"}},
    {"samples",
     lua::guarded<excitation_functions::samples>,
     lua::Kind::function,
     {"excitation.samples(file, { time, value }) or excitation.samples{ t, M } -> excitation",
      "Straight lines between points, from two columns of a CSV file or from two tables (or vectors). Outside, the "
      "first and the last value hold. time and value name the columns or number them; without them they are the "
      "columns t (or time) and M, else the first and the second.",
      "M = excitation.samples{ t = { 0, 1, 3 }, M = { 0, 2, 0 } }\nprint(M(0.5), M(2), M(9))  --> 1.0\t1.0\t0.0"}},
    {"scripted",
     lua::guarded<excitation_functions::scripted>,
     lua::Kind::function,
     {"excitation.scripted(f, { breaks = {}, period }) -> excitation",
      "Any Lua function of t, or of t, theta, velocity: with two or more parameters (or ...) it is called with all "
      "three. breaks are times at which it jumps or kinks, so that integrators do not step across them; with a period, "
      "they repeat. Where M is expected a function alone will do.",
      "M = excitation.scripted(function(t) return t % 3 < 2 and 1 or 0 end, { breaks = { 0, 2 }, period = 3 })\n"
      "print(M(7), M:next_break(7))  --> 1.0\t8.0"}},
};

}  // namespace

const lua::Class excitation_module{
    "excitation",
    {"excitation.NAME{ ... } -> excitation",
     "The torque M(t) on the mass, made of terms that add and scale. All know the times at which they jump or kink. A "
     "Lua function or a number can stand wherever an excitation is expected.",
     "M = excitation.harmonic{ frequency = 1 } + 0.5 * excitation.pulse{ at = 1.5, width = 0.2 }\n"
     "print(M:next_break(0))  --> 1.5"},
    excitation_module_members,
};

}  // namespace dinal::api
