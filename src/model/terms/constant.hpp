// excitation.constant: the same torque at all times.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

struct Constant {
    static const TermText about;

    double level = 0;

    [[nodiscard]] double value(double, double = 0) const { return level; }
    [[nodiscard]] double next_break(double) const { return never; }
    [[nodiscard]] double constant_from() const { return -never; }
    [[nodiscard]] double most() const { return std::fabs(level); }
    [[nodiscard]] double repeats_after() const { return 0; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double /*inside*/, Sum& sum) const {
        sum.add_constant(level);
    }
    void delay_by(double) {}
    [[nodiscard]] std::string formula(double gain) const { return number(gain * level); }
};

inline constexpr text::Option constant_options[] = {
    {"level", rows::torque, text::needed, text::any_finite, "the torque", text::fills<&Constant::level>},
};
inline constexpr TermText Constant::about{{"excitation.constant", "excitation.constant{ level = 1 }", constant_options},
                                          "The same torque at all times.",
                                          "print(excitation.constant{ level = 2 }(10))  --> 2.0"};

}  // namespace dinal::model::terms
