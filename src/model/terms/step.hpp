// excitation.step: a level from a given time on.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// 0 before `at`, `amplitude` from then on
struct Step {
    static const TermText about;

    double amplitude = 1, at = 0;

    [[nodiscard]] double value(double t, double = 0) const { return t < at ? 0 : amplitude; }
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at}); }
    [[nodiscard]] double constant_from() const { return at; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at) sum.add_constant(amplitude);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const { return number(gain * amplitude) + from_on(at); }
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

}  // namespace dinal::model::terms
