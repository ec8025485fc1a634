// excitation.square: two alternating levels.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// +amplitude for the first `duty` part of each period, -amplitude for the rest
struct Square {
    static const TermText about;

    double amplitude = 1, period = 0, duty = 0.5, at = 0;

    struct Cycle {
        double fall, end;
    };
    [[nodiscard]] Cycle cycle(double t) const {
        const auto edge = [this](double n) { return at + n * period; };
        const double n = cycle_at(t, (t - at) / period, edge);
        return {edge(n + duty), edge(n + 1)};
    }
    [[nodiscard]] double value(double t, double = 0) const { return t < cycle(t).fall ? amplitude : -amplitude; }
    [[nodiscard]] double next_break(double t) const {
        const Cycle c = cycle(t);
        return later(t, c.fall > t ? c.fall : c.end);
    }
    [[nodiscard]] double constant_from() const { return never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] double repeats_after() const { return period; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        sum.add_constant(value(inside));
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
        return wave("square wave", gain * amplitude, period, at) +
               (duty == 0.5 ? "" : ", positive for " + number(duty) + " of it");
    }
};

inline constexpr text::Option square_options[] = {
    rows::amplitude<Square>(),
    rows::period<Square>(),
    rows::frequency<Square>(),
    rows::omega<Square>(),
    {"duty", "", text::its_own, text::between_0_and_1, "the fraction of a period for which it is positive",
     text::fills<&Square::duty>},
    rows::at<Square>(rows::where_a_period_begins),
};
inline constexpr TermText Square::about{
    {"excitation.square", "excitation.square{ period = 2 }", square_options},
    "+amplitude for the fraction `duty` of each period, then -amplitude. A period begins at `at`.",
    "M = excitation.square{ period = 4, duty = 0.25 }\nprint(M(0), M(0.9), M(1))  --> 1.0\t1.0\t-1.0"};

}  // namespace dinal::model::terms
