// excitation.polynomial: powers of time, at all times.
#pragma once

#include <optional>
#include <vector>

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// c0 + c1 (t - at) + c2 (t - at)^2 + ..., for all t
struct Polynomial {
    static const TermText about;

    std::vector<double> coefficients;
    double at = 0;

    /// Horner's scheme in t - at.
    [[nodiscard]] double value(double t) const {
        const double x = t - at;
        double sum = 0;
        for (auto c = coefficients.rbegin(); c != coefficients.rend(); ++c) {
            sum = sum * x + *c;
        }
        return sum;
    }
    [[nodiscard]] double next_break(double) const { return never; }
    [[nodiscard]] double constant_from() const {
        const auto varies = [](double c) { return c != 0; };
        return coefficients.size() < 2 || std::none_of(coefficients.begin() + 1, coefficients.end(), varies) ? -never
                                                                                                             : never;
    }
    [[nodiscard]] double most() const { return coefficients.size() < 2 ? std::fabs(value(0)) : never; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_powers(at, coefficients);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::optional<text::Error> complaint() const {
        if (!coefficients.empty()) return std::nullopt;
        return text::Error{.sentence = "coefficients is empty; give at least one, as in coefficients = { 1, 0.5 }",
                           .option = "coefficients"};
    }
    [[nodiscard]] std::string formula(double gain) const {
        std::string text;
        for (std::size_t i = 0; i < coefficients.size(); ++i) {
            const double c = gain * coefficients[i];
            if (c != 0) {
                text += text.empty() ? (c < 0 ? "-" : "") : (c < 0 ? " - " : " + ");
                const std::string power = since(at) + (i == 1 ? "" : "^" + std::to_string(i));
                text += i == 0 ? number(std::fabs(c)) : factor(std::fabs(c)) + power;
            }
        }
        return text.empty() ? "0" : text;
    }
};

inline constexpr text::Option polynomial_options[] = {
    {"coefficients", "torque, per time unit, ...", text::needed, text::any_finite, "the constant one first",
     text::fills<&Polynomial::coefficients>},
    rows::at<Polynomial>("from which time is counted"),
};
inline constexpr TermText Polynomial::about{
    {"excitation.polynomial", "excitation.polynomial{ coefficients = { 1, 0.5 } }", polynomial_options},
    "c[1] + c[2] (t - at) + c[3] (t - at)^2 + ... at all times; cut a piece out with e:window.",
    "print(excitation.polynomial{ coefficients = { 1, 0, 2 } }(3))  --> 19.0"};

}  // namespace dinal::model::terms
