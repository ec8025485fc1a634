// excitation.triangle: up and down in straight lines.
#pragma once

#include "model/terms/term.hpp"

namespace dinal::model::terms {

/// a triangle wave with the zeros and peaks of a sine: 0, +amplitude, 0, -amplitude, 0
struct Triangle {
    static const TermText about;

    double amplitude = 1, period = 0, at = 0;

    /// A straight piece between two corners, at a quarter and three quarters of each period.
    struct Side {
        double start, end;
        bool falling;
    };
    [[nodiscard]] Side side(double t) const {
        const auto corner = [this](double n) { return at + (0.5 * n + 0.25) * period; };
        const double n = cycle_at(t, 2 * ((t - at) / period) - 0.5, corner);
        return {corner(n), corner(n + 1), std::fmod(n, 2) == 0};
    }
    [[nodiscard]] double value(double t) const {
        const Side piece = side(t);
        const double first = piece.falling ? amplitude : -amplitude;
        return first - 2 * first * fraction(t, piece.start, piece.end);
    }
    [[nodiscard]] double next_break(double t) const { return later(t, side(t).end); }
    [[nodiscard]] double constant_from() const { return never; }
    [[nodiscard]] double most() const { return std::fabs(amplitude); }
    [[nodiscard]] double repeats_after() const { return period; }
    [[nodiscard]] Detail detail() const { return no_detail; }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Side piece = side(inside);
        const double first = piece.falling ? amplitude : -amplitude;
        sum.add_line(piece.start, first, piece.end > piece.start ? -2 * first / (piece.end - piece.start) : 0);
    }
    void delay_by(double d) { at += d; }
    [[nodiscard]] std::string formula(double gain) const { return wave("triangle wave", gain * amplitude, period, at); }
};

inline constexpr text::Option triangle_options[] = {
    rows::amplitude<Triangle>(),
    rows::period<Triangle>(),
    rows::frequency<Triangle>(),
    rows::omega<Triangle>(),
    rows::at<Triangle>(rows::where_a_period_begins),
};
inline constexpr TermText Triangle::about{
    {"excitation.triangle", "excitation.triangle{ period = 2 }", triangle_options},
    "Straight lines through 0, amplitude, 0, -amplitude. A period begins at `at`.",
    "M = excitation.triangle{ period = 4 }\nprint(M(0.5), M(1), M(3))  --> 0.5\t1.0\t-1.0"};

}  // namespace dinal::model::terms
