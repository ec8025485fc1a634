// Terms of straight lines: excitation.constant, step, pulse and ramp.
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
    {.name = "amplitude",
     .unit = rows::torque,
     .meaning = "the torque from the time `at` on",
     .filled = text::fills<&Step::amplitude>},
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
    {"slope", "torque per time unit", text::its_own, text::any_finite, "slope", text::fills<&Ramp::slope>},
    rows::at<Ramp>(),
    {"duration", rows::time, "math.huge", text::positive_or_infinite, "duration of the rise",
     text::fills<&Ramp::duration>},
};
inline constexpr TermText Ramp::about{
    {"excitation.ramp", "excitation.ramp{ slope = 2, at = 1 }", ramp_options},
    "0 before `at`, then rising with slope; constant after duration.",
    "M = excitation.ramp{ slope = 2, at = 1, duration = 3 }\nprint(M(0), M(2), M(9))  --> 0.0\t2.0\t6.0"};

}  // namespace dinal::model::terms
