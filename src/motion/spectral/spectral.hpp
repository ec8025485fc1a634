// integrator.spectral: Chebyshev panels between events and breaks of M, each solved to rounding, for any M.
#pragma once

#include <algorithm>
#include <limits>

#include "motion/method.hpp"

namespace dinal::motion::spectral {

/// The longest panel in natural periods, whatever max_panel is.
inline constexpr double longest_panel = 0.6;
/// The longest panel of a block without a spring, which has no period, as a fraction of the run.
inline constexpr double part_of_run = 1.0 / 16;

struct Spectral {
    double tolerance = 1e-12;                                    ///< relative, for the motion on each panel
    double max_panel = std::numeric_limits<double>::infinity();  ///< longest panel, time units
    double narrowest = std::numeric_limits<double>::infinity();  ///< pulses of this width are never missed, time units

    static const MethodText about;
    /// The longest panel whose samples miss no pulse of the width `narrowest`, time units.
    double widest_looks() const;
    /// The longest panel of a run, time units.
    double longest(const Problem& problem) const;
    Resolution resolution(const model::Oscillator& system) const;
    Cut cut() const { return {.tolerance = tolerance, .longest = std::min(max_panel, widest_looks())}; }
    Run run(const Problem& problem) const;
};

inline constexpr text::Option spectral_options[] = {
    text::option<&Spectral::tolerance>("tolerance", "relative error on each panel", {.range = text::between_0_and_1}),
    {"max_panel", "time units", "0.6 T0", text::positive_or_infinite, "the longest panel",
     text::fills<&Spectral::max_panel>},
    {"narrowest", "time units", "0.0585 T0", text::positive_or_infinite,
     "length of the shortest pulse of a function M, which is then never missed", text::fills<&Spectral::narrowest>},
};

inline constexpr MethodText Spectral::about{
    {"integrator.spectral", "integrator.spectral{ tolerance = 1e-12 }", spectral_options},
    "The motion as polynomials on panels between events and breaks of M, accurate to rounding if the samples "
    "resolve M. Events are located. Noise in M limits the accuracy. A pulse of a function M that cannot be read "
    "may fall between two samples and be missed: run.gap is the longest time between them. Give its times by "
    "excitation.scripted(f, { breaks = {...} }), or the length of the shortest pulse by narrowest.",
    "sys = nondimensional{ friction_ratio = 0.167 }\n"
    "run = sys:simulate{ velocity0 = 2*math.pi, t_end = 3, dt = 0.5, integrator = integrator.spectral{} }\n"
    "print(string.format(\"%.9f\", (run:at(3))))  --> 0.155151392"};

}  // namespace dinal::motion::spectral
