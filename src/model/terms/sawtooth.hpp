// excitation.sawtooth: a ramp that drops back and begins again.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// rises from -amplitude to +amplitude over each period and drops back
struct Sawtooth {
    static const TermText about;

    double amplitude = 1, period = 0, at = 0;

    struct Cycle {
        double start, end;
    };
    [[nodiscard]] Cycle cycle(double t) const {
        const auto edge = [this](double n) { return at + n * period; };
        const double n = cycle_at(t, (t - at) / period, edge);
        return {edge(n), edge(n + 1)};
    }
    [[nodiscard]] double value(double t) const {
        const Cycle c = cycle(t);
        return -amplitude + 2 * amplitude * fraction(t, c.start, c.end);
    }
    [[nodiscard]] double next_break(double t) const { return later(t, cycle(t).end); }
    [[nodiscard]] double constant_from() const { return never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] double repeats_after() const { return period; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const { return wave("sawtooth", gain * amplitude, period, at); }
};

inline constexpr text::Option sawtooth_options[] = {
    {.name = "amplitude",
     .unit = "torque",
     .meaning = "its greatest value",
     .filled = text::fills<&Sawtooth::amplitude>},
    {.name = "period",
     .unit = "time units",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "after which it begins again",
     .filled = text::fills<&Sawtooth::period>},
    {.name = "frequency",
     .unit = "cycles per time unit",
     .otherwise = text::needed,
     .range = text::positive,
     .meaning = "1 / period",
     .filled = text::sets<period_of_frequency<Sawtooth>>,
     .instead_of_previous = true},
    {.name = "at", .unit = "time units", .meaning = "where a period begins", .filled = text::fills<&Sawtooth::at>},
};
inline constexpr TermText Sawtooth::about{
    {.name = "excitation.sawtooth", .example = "excitation.sawtooth{ period = 2 }", .options = sawtooth_options},
    "Rises from -amplitude to amplitude over each period and drops back. A period begins at `at`.",
    "M = excitation.sawtooth{ period = 2 }\nprint(M(0), M(1), M(1.5))  --> -1.0\t0.0\t0.5"};

}  // namespace dinal::model::terms
