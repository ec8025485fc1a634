// excitation.ramp: a linear rise, unlimited or up to a level.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// 0 before `at`, rising by `slope` per time unit for `duration`, then constant
struct Ramp {
    static const TermText about;

    double slope = 1, at = 0, duration = never;

    [[nodiscard]] double value(double t, double rest = 0) const {
        if (t < at) {
            return 0;
        }
        return slope * (t < at + duration ? (t - at) + rest : duration);
    }
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at, at + duration}); }
    [[nodiscard]] double constant_from() const { return at + duration; }
    [[nodiscard]] double most() const { return slope == 0 ? 0 : std::fabs(slope * duration); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at + duration) {
            sum.add_constant(slope * duration);
        } else if (inside >= at) {
            sum.add_line(at, 0, slope);
        }
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
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
