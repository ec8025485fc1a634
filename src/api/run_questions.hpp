// What a run is asked besides its columns: run:spectrum, run:poincare.
#pragma once

#include <optional>
#include <string>

#include "analysis/spectrum.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

enum class SpectrumMethod { amplitude, welch };
inline constexpr const char* method_names[] = {"amplitude", "welch"};
struct SpectrumOptions {
    std::string of = "theta";
    SpectrumMethod method = SpectrumMethod::amplitude;
    double segments = 8;
    analysis::SpectrumWindow window = analysis::SpectrumWindow::hann;
    std::optional<double> from = {};
};
inline constexpr const char* window_names[] = {"hann", "rectangle", "flat top"};
inline constexpr text::Option spectrum_options[] = {
    {.name = "of", .meaning = "the column", .filled = text::fills<&SpectrumOptions::of>},
    {.name = "method",
     .meaning = "amplitude of the whole record, or welch: power density, the mean over segments that overlap by half",
     .filled = text::fills<&SpectrumOptions::method>,
     .choices = method_names},
    {.name = "segments",
     .range = {"be a whole number from 1 to 10000", [](double x) { return text::is_whole(x, 1, 1e4); }},
     .meaning = "for method welch: more segments make the result smoother, and coarser in frequency",
     .filled = text::fills<&SpectrumOptions::segments>},
    {.name = "window",
     .meaning = "the weights of the rows: hann in general, rectangle for whole periods, flat top for "
                "amplitudes",
     .filled = text::fills<&SpectrumOptions::window>,
     .choices = window_names},
    {.name = "from",
     .unit = "time units",
     .otherwise = "the first row",
     .meaning = "rows before this time (the transient) are left out",
     .filled = text::fills<&SpectrumOptions::from>},
};
inline constexpr text::Call spectrum_call{
    "run:spectrum", "run:spectrum{ of = \"theta\", window = \"hann\" }", spectrum_options, true, nullptr, "of"};

struct PoincareOptions {
    std::optional<double> period = {}, frequency = {}, omega = {};
    std::optional<double> from = {};
};
inline constexpr text::Option poincare_options[] = {
    {.name = "period",
     .unit = "time units",
     .otherwise = "that of M",
     .range = text::positive,
     .meaning = "time between samples; needed if the period of M is not known, as for a Lua function",
     .filled = text::fills<&PoincareOptions::period>},
    {.name = "frequency",
     .unit = "cycles per time unit",
     .range = text::positive,
     .meaning = "1/period, instead of period",
     .filled = text::fills<&PoincareOptions::frequency>},
    {.name = "omega",
     .unit = "rad per time unit",
     .range = text::positive,
     .meaning = "2 pi/period, instead of period",
     .filled = text::fills<&PoincareOptions::omega>},
    {.name = "from",
     .unit = "time units",
     .otherwise = "the beginning",
     .meaning = "the time of the first sample, after the transient; it also chooses the phase",
     .filled = text::fills<&PoincareOptions::from>},
};
inline constexpr text::Call poincare_call{"run:poincare", "run:poincare{ period = 1 }", poincare_options};

int spectrum_of_run(lua_State* L);
int poincare_of_run(lua_State* L);

inline constexpr lua::Doc spectrum_doc{
    "run:spectrum{ OPTIONS } -> data",
    "The one-sided amplitude spectrum of a column, from rows with one dt: frequency (cycles per time unit, up to "
    "half a cycle per dt) and amplitude (of a sine). A sine of whole periods has its amplitude in any window; "
    "one midway between two frequencies has 64 % of it in rectangle, 85 % in hann and 99.9 % in flat top. The "
    "mean is at frequency 0. With method = \"welch\" the second column is density: its sum times the step of "
    "frequency is the variance. run:spectrum(\"theta\", { OPTIONS }) is the same with of = \"theta\".",
    "run = nondimensional{}:simulate{ theta0 = 1, t_end = 16, dt = 0.125 }\n"
    "s = run:spectrum{ of = \"theta\", window = \"rectangle\" }\n"
    "i = s.amplitude:argmax()\n"
    "print(string.format(\"%.2f %.2f\", s.frequency[i], s.amplitude[i]))  --> 1.00 1.00",
    {&spectrum_call}};
inline constexpr lua::Doc poincare_doc{
    "run:poincare{ OPTIONS } -> data",
    "The motion sampled once a period: t, theta and velocity. A periodic motion gives one point, a subharmonic "
    "one several, an irregular one a cloud; the plot shows velocity over theta.",
    "run = nondimensional{ zeta = 0.2 }:simulate{ M = excitation.harmonic{ frequency = 0.5 }, t_end = 60, dt = 1 }\n"
    "d = run:poincare{ from = 40 }\n"
    "print(#d, d.theta:max() - d.theta:min() < 1e-9)  --> 11\ttrue",
    {&poincare_call}};

}  // namespace dinal::api
