// Terms of straight lines: excitation.constant, step, pulse and ramp, and the waves square, sawtooth and triangle.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

struct Constant {
    static const TermText about;

    double amplitude = 0;

    double value(double, double = 0) const { return amplitude; }
    double next_break(double) const { return never; }
    double constant_from() const { return -never; }
    double most() const { return std::fabs(amplitude); }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_constant(amplitude);
    }
    void delay_by(double) {}
    std::string formula(double gain) const { return number(gain * amplitude); }
};

inline constexpr text::Option constant_options[] = {
    {"amplitude", rows::torque, text::needed, text::any_finite, "the torque", text::fills<&Constant::amplitude>},
};
inline constexpr TermText Constant::about{
    {"excitation.constant", "excitation.constant{ amplitude = 1 }", constant_options, false, nullptr, "amplitude"},
    "The same torque at all times; excitation.constant(2) will do.",
    "print(excitation.constant{ amplitude = 2 }(10), excitation.constant(3)(0))  --> 2.0\t3.0"};

/// 0 before `at`, `amplitude` from then on
struct Step {
    static const TermText about;

    double amplitude = 1, at = 0;

    double value(double t, double = 0) const { return t < at ? 0 : amplitude; }
    double next_break(double t) const { return first_after(t, {at}); }
    double constant_from() const { return at; }
    double most() const { return std::fabs(amplitude); }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at) sum.add_constant(amplitude);
    }
    std::string formula(double gain) const { return number(gain * amplitude) + from_on(at); }
};

inline constexpr text::Option step_options[] = {
    text::option<&Step::amplitude>("amplitude", "the torque from the time `at` on", {.unit = rows::torque}),
    rows::at<Step>("the time of the step"),
};
inline constexpr TermText Step::about{
    {"excitation.step", "excitation.step{ amplitude = 1, at = 2 }", step_options},
    "0 before the time `at`, amplitude from then on.",
    "M = excitation.step{ amplitude = 2, at = 1 }\nprint(M(0.9), M(1))  --> 0.0\t2.0"};

/// `amplitude` for at <= t < at + width, otherwise 0
struct Pulse {
    static const TermText about;

    double amplitude = 1, at = 0, width = 0;

    double value(double t, double = 0) const { return t >= at && t < at + width ? amplitude : 0; }
    double next_break(double t) const { return first_after(t, {at, at + width}); }
    double constant_from() const { return at + width; }
    double most() const { return std::fabs(amplitude); }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at && inside < at + width) sum.add_constant(amplitude);
    }
    std::string formula(double gain) const { return number(gain * amplitude) + between(at, at + width); }
};

inline constexpr text::Option pulse_options[] = {
    rows::amplitude<Pulse>("its height"),
    rows::at<Pulse>(),
    rows::width<Pulse>(),
};
inline constexpr TermText Pulse::about{
    {"excitation.pulse", "excitation.pulse{ at = 1, width = 0.2 }", pulse_options},
    "amplitude for at <= t < at + width, otherwise 0.",
    "M = excitation.pulse{ at = 1, width = 0.5 } + excitation.pulse{ at = 3, width = 0.5 }\nprint(M(1.2), M(2), "
    "M(3.2))  --> 1.0\t0.0\t1.0"};

/// 0 before `at`, rising by `slope` per time unit for `duration`, then constant
struct Ramp {
    static const TermText about;

    double slope = 1, at = 0, duration = never;

    double value(double t, double rest = 0) const {
        if (t < at) {
            return 0;
        }
        return slope * (t < at + duration ? (t - at) + rest : duration);
    }
    double next_break(double t) const { return first_after(t, {at, at + duration}); }
    double constant_from() const { return at + duration; }
    double most() const { return slope == 0 ? 0 : std::fabs(slope * duration); }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at + duration) {
            sum.add_constant(slope * duration);
        } else if (inside >= at) {
            sum.add_line(at, 0, slope);
        }
    }
    std::string formula(double gain) const {
        const std::string rise = factor(gain * slope) + since(at);
        return duration == never ? rise + from_on(at)
                                 : rise + between(at, at + duration) + ", then " + number(gain * slope * duration);
    }
};

inline constexpr text::Option ramp_options[] = {
    text::option<&Ramp::slope>("slope", "slope", {.unit = "torque per time unit"}),
    rows::at<Ramp>(),
    {"duration", rows::time, "math.huge", text::positive_or_infinite, "duration of the rise",
     text::fills<&Ramp::duration>},
};
inline constexpr TermText Ramp::about{
    {"excitation.ramp", "excitation.ramp{ slope = 2, at = 1 }", ramp_options},
    "0 before `at`, then rising with slope; constant after duration.",
    "M = excitation.ramp{ slope = 2, at = 1, duration = 3 }\nprint(M(0), M(2), M(9))  --> 0.0\t2.0\t6.0"};

/// +amplitude for the first `duty` part of each period, -amplitude for the rest
struct Square {
    static const TermText about;

    double amplitude = 1, period = 0, duty = 0.5, at = 0;

    struct Cycle {
        double fall, end;
    };
    Cycle cycle(double t) const {
        const auto edge = [this](double n) { return at + n * period; };
        const double n = cycle_at(t, (t - at) / period, edge);
        return {edge(n + duty), edge(n + 1)};
    }
    double value(double t, double = 0) const { return t < cycle(t).fall ? amplitude : -amplitude; }
    double next_break(double t) const {
        const Cycle c = cycle(t);
        return later(t, c.fall > t ? c.fall : c.end);
    }
    double constant_from() const { return never; }
    double most() const { return std::fabs(amplitude); }
    double repeats_after() const { return period; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        sum.add_constant(value(inside));
    }
    std::string formula(double gain) const {
        return wave("square wave", gain * amplitude, period, at) +
               (duty == 0.5 ? "" : ", positive for " + number(duty) + " of it");
    }
};

inline constexpr text::Option square_options[] = {
    rows::amplitude<Square>(),
    rows::period<Square>(),
    rows::frequency<Square>(),
    rows::omega<Square>(),
    text::option<&Square::duty>("duty", "the fraction of a period for which it is positive",
                                {.range = text::between_0_and_1}),
    rows::at<Square>(rows::where_a_period_begins),
};
inline constexpr TermText Square::about{
    {"excitation.square", "excitation.square{ period = 2 }", square_options},
    "+amplitude for the fraction `duty` of each period, then -amplitude. A period begins at `at`.",
    "M = excitation.square{ period = 4, duty = 0.25 }\nprint(M(0), M(0.9), M(1))  --> 1.0\t1.0\t-1.0"};

/// rises from -amplitude to +amplitude over each period and drops back
struct Sawtooth {
    static const TermText about;

    double amplitude = 1, period = 0, at = 0;

    struct Cycle {
        double start, end;
    };
    Cycle cycle(double t) const {
        const auto edge = [this](double n) { return at + n * period; };
        const double n = cycle_at(t, (t - at) / period, edge);
        return {edge(n), edge(n + 1)};
    }
    double value(double t) const {
        const Cycle c = cycle(t);
        return -amplitude + 2 * amplitude * fraction(t, c.start, c.end);
    }
    double next_break(double t) const { return later(t, cycle(t).end); }
    double constant_from() const { return never; }
    double most() const { return std::fabs(amplitude); }
    double repeats_after() const { return period; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Cycle c = cycle(inside);
        sum.add_line(c.start, -amplitude, c.end > c.start ? 2 * amplitude / (c.end - c.start) : 0);
    }
    std::string formula(double gain) const { return wave("sawtooth", gain * amplitude, period, at); }
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

/// a triangle wave with the zeros and peaks of a sine: 0, +amplitude, 0, -amplitude, 0
struct Triangle {
    static const TermText about;

    double amplitude = 1, period = 0, at = 0;

    /// A straight piece between two corners, at a quarter and three quarters of each period.
    struct Flank {
        double start, end;
        bool falling;
    };
    Flank side(double t) const {
        const auto corner = [this](double n) { return at + (0.5 * n + 0.25) * period; };
        const double n = cycle_at(t, 2 * ((t - at) / period) - 0.5, corner);
        return {corner(n), corner(n + 1), std::fmod(n, 2) == 0};
    }
    double value(double t) const {
        const Flank piece = side(t);
        const double first = piece.falling ? amplitude : -amplitude;
        return first - 2 * first * fraction(t, piece.start, piece.end);
    }
    double next_break(double t) const { return later(t, side(t).end); }
    double constant_from() const { return never; }
    double most() const { return std::fabs(amplitude); }
    double repeats_after() const { return period; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Flank piece = side(inside);
        const double first = piece.falling ? amplitude : -amplitude;
        sum.add_line(piece.start, first, piece.end > piece.start ? -2 * first / (piece.end - piece.start) : 0);
    }
    std::string formula(double gain) const { return wave("triangle wave", gain * amplitude, period, at); }
};

inline constexpr text::Option triangle_options[] = {
    rows::amplitude<Triangle>(),
    rows::period<Triangle>(),
    rows::frequency<Triangle>(),
    rows::omega<Triangle>(),
    rows::at<Triangle>(rows::where_a_period_begins),
};
inline constexpr TermText Triangle::about{
    {"excitation.triangle", "excitation.triangle{ period = 2 }", triangle_options},
    "Straight lines through 0, amplitude, 0, -amplitude. A period begins at `at`.",
    "M = excitation.triangle{ period = 4 }\nprint(M(0.5), M(1), M(3))  --> 0.5\t1.0\t-1.0"};

}  // namespace dinal::model::terms
