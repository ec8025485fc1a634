// excitation.exponential: a decay or growth from a given time on.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// amplitude exp(-(t - at) / tau) from `at` on, 0 before; tau < 0 grows
struct Exponential {
    static const TermText about;

    double amplitude = 1, tau = 0, at = 0;

    [[nodiscard]] double value(double t, double rest = 0) const {
        return t < at ? 0 : grown(amplitude, -((t - at) + rest) / tau);
    }
    /// Returns amplitude exp(x), also if exp(x) alone overflows.
    static double grown(double amplitude, double x) {
        constexpr double most = 700;
        if (std::fabs(x) < most || amplitude == 0) return amplitude == 0 ? 0 : amplitude * std::exp(x);
        const double half = std::exp(x / 2);
        return amplitude * half * half;
    }
    [[nodiscard]] double next_break(double t) const { return first_after(t, {at}); }
    [[nodiscard]] double constant_from() const { return never; }
    [[nodiscard]] double most() const { return amplitude == 0 ? 0 : tau > 0 ? std::fabs(amplitude) : never; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        if (inside >= at) sum.add_exponential(amplitude, -1 / tau, at);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
        return factor(gain * amplitude) + "exp(-" + since(at) + "/" + number(tau) + ")" + from_on(at);
    }
};

inline constexpr text::Option exponential_options[] = {
    rows::amplitude<Exponential>("its first value"),
    {"tau", rows::time, text::needed, text::not_zero, "time in which it falls to 1/e", text::fills<&Exponential::tau>},
    rows::at<Exponential>(),
};
inline constexpr TermText Exponential::about{
    {"excitation.exponential", "excitation.exponential{ amplitude = 2, tau = 0.5 }", exponential_options},
    "amplitude exp(-(t - at)/tau) from `at` on, 0 before. A negative tau grows.",
    "M = excitation.exponential{ amplitude = 2, tau = 0.5, at = 1 }\nprint(M(0.9), M(1))  --> 0.0\t2.0"};

}  // namespace dinal::model::terms
