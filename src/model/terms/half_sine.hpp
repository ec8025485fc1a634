// excitation.half_sine: a shock.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// one half wave of a sine over [at, at + width], otherwise 0
struct HalfSine {
    static const TermText about;

    double amplitude = 1, at = 0, width = 0;

    [[nodiscard]] double value(double t, double rest = 0) const {
        if (t < at || t >= at + width) {
            return 0;
        }
        return amplitude * std::sin(std::numbers::pi * (((t - at) + rest) / width));
    }
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at, at + width}); }
    [[nodiscard]] double constant_from() const { return at + width; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at && inside < at + width) sum.add_sine(amplitude, std::numbers::pi / width, at, 0);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
        return factor(gain * amplitude) + "sin(pi " + since(at) + "/" + number(width) + ")" + between(at, at + width);
    }
};

inline constexpr text::Option half_sine_options[] = {
    rows::amplitude<HalfSine>(),
    rows::at<HalfSine>(),
    rows::width<HalfSine>(),
};
inline constexpr TermText HalfSine::about{
    {"excitation.half_sine", "excitation.half_sine{ at = 1, width = 0.2 }", half_sine_options},
    "One half wave of a sine from `at` to at + width, 0 elsewhere: a shock.",
    "print(excitation.half_sine{ amplitude = 3, width = 2 }(1))  --> 3.0"};

}  // namespace dinal::model::terms
