// excitation.pulse: a level between two times.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// `amplitude` for at <= t < at + width, otherwise 0
struct Pulse {
    static const TermText about;

    double amplitude = 1, at = 0, width = 0;

    [[nodiscard]] double value(double t, double = 0) const { return t >= at && t < at + width ? amplitude : 0; }
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at, at + width}); }
    [[nodiscard]] double constant_from() const { return at + width; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at && inside < at + width) sum.add_constant(amplitude);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const { return number(gain * amplitude) + between(at, at + width); }
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

}  // namespace dinal::model::terms
