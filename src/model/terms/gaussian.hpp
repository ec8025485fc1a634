// excitation.gaussian: a smooth bump.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// amplitude exp(-((t - at) / sigma)^2 / 2): `sigma` is the standard deviation
struct Gaussian {
    static const TermText about;

    double amplitude = 1, at = 0, sigma = 0;

    [[nodiscard]] double value(double t, double rest = 0) const {
        const double x = ((t - at) + rest) / sigma;
        return amplitude * std::exp(-0.5 * x * x);
    }
    [[nodiscard]] double next_break(double) const { return never; }
    [[nodiscard]] double constant_from() const {
        constexpr double vanished = 39;  // exp(-39^2 / 2) is below the smallest double
        return std::nextafter(at + vanished * sigma, never);
    }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const {
        constexpr double visible = 10;  // exp(-10^2 / 2) = 2e-22 is lost in rounding
        return {at - visible * sigma, at + visible * sigma, sigma / 2};
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const {
        return factor(gain * amplitude) + "exp(-(" + since(at) + "/" + number(sigma) + ")^2/2)";
    }
};

inline constexpr text::Option gaussian_options[] = {
    rows::amplitude<Gaussian>(),
    rows::at<Gaussian>("its middle"),
    {"sigma", rows::time, text::needed, text::positive, "its standard deviation", text::fills<&Gaussian::sigma>},
};
inline constexpr TermText Gaussian::about{
    {"excitation.gaussian", "excitation.gaussian{ at = 1, sigma = 0.2 }", gaussian_options},
    "A smooth bump, amplitude exp(-((t - at)/sigma)^2 / 2): sigma is the standard deviation. Any width is safe "
    "with the spectral integrator; others need steps of at most sigma/2.",
    "M = excitation.gaussian{ amplitude = 2, at = 3, sigma = 0.5 }\nprint(M(3), M(3.5) / M(3) == math.exp(-0.5))  --> "
    "2.0\ttrue"};

}  // namespace dinal::model::terms
