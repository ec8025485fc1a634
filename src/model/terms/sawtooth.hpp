// excitation.sawtooth: a ramp that drops back periodically.
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
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Cycle c = cycle(inside);
        sum.add_line(c.start, -amplitude, c.end > c.start ? 2 * amplitude / (c.end - c.start) : 0);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const { return wave("sawtooth", gain * amplitude, period, at); }
};

inline constexpr text::Option sawtooth_options[] = {
    rows::amplitude<Sawtooth>(),
    rows::period<Sawtooth>(),
    rows::frequency<Sawtooth>(),
    rows::omega<Sawtooth>(),
    rows::at<Sawtooth>(rows::where_a_period_begins),
};
inline constexpr TermText Sawtooth::about{
    {"excitation.sawtooth", "excitation.sawtooth{ period = 2 }", sawtooth_options},
    "Rises from -amplitude to amplitude over each period and drops back. A period begins at `at`.",
    "M = excitation.sawtooth{ period = 2 }\nprint(M(0), M(1), M(1.5))  --> -1.0\t0.0\t0.5"};

}  // namespace dinal::model::terms
