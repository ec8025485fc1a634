// excitation.constant: the same torque at all times.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

struct Constant {
    static const TermText about;

    double amplitude = 0;

    [[nodiscard]] double value(double, double = 0) const { return amplitude; }
    [[nodiscard]] double next_break(double) const { return never; }
    [[nodiscard]] double constant_from() const { return -never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_constant(amplitude);
    }
    void delay_by(double) {}
    [[nodiscard]] std::string formula(double gain) const { return number(gain * amplitude); }
};

inline constexpr text::Option constant_options[] = {
    {"amplitude", rows::torque, text::needed, text::any_finite, "the torque", text::fills<&Constant::amplitude>},
};
inline constexpr TermText Constant::about{
    {"excitation.constant", "excitation.constant{ amplitude = 1 }", constant_options, false, nullptr, "amplitude"},
    "The same torque at all times; excitation.constant(2) will do.",
    "print(excitation.constant{ amplitude = 2 }(10), excitation.constant(3)(0))  --> 2.0\t3.0"};

}  // namespace dinal::model::terms
