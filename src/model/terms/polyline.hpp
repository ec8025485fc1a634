// excitation.samples: straight lines, a cubic spline or held values between points, once or periodically.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "model/terms/term.hpp"

namespace dinal::model::terms {

enum class Interpolation { linear, cubic, hold };
inline constexpr const char* interpolation_names[] = {"linear", "cubic", "hold"};

/// Times strictly increasing, at least one point.
struct Samples {
    std::vector<double> t, M;
    Interpolation interpolation = Interpolation::linear;
    std::optional<double> period = {};  ///< after which the points repeat
    std::string origin = {};            ///< source in words for the user; not used by the core
    double delay = 0;                   ///< how much later `t` is than the original times
    std::vector<double> slopes = {};    ///< slopes of a cubic spline at the points, computed
};
inline constexpr text::Option between_options[] = {
    text::option<&Samples::interpolation>(
        "interpolation",
        "interpolation between the points: straight lines, a cubic spline (not-a-knot, or periodic), or each value "
        "held until the next time",
        {.choices = interpolation_names}),
    text::option<&Samples::period>("period", "period of the points; a last point one period after the first repeats it",
                                   {.unit = "time units", .range = text::positive}),
};
inline constexpr text::Option points_options[] = {
    {"t", "time units", text::needed, text::any_finite, "times, which increase", text::fills<&Samples::t>},
    {"M", "torque", text::needed, text::any_finite, "the torque at these times", text::fills<&Samples::M>},
};
inline constexpr auto samples_options = text::joined(points_options, between_options);

/// A line through the samples. Outside, the first and last values hold unless the samples are periodic.
// A shared pointer to const: copies of an excitation are cheap and safe.
struct Polyline {
    static const TermText about;

    std::shared_ptr<const Samples> samples;

    Polyline(std::shared_ptr<const Samples> points) : samples(prepared(std::move(points))), most_(greatest()) {}

    double value(double t, double rest = 0) const {
        const Samples& s = *samples;
        if (s.period) return on_piece(piece(t), t, rest);
        if (!(t >= s.t.front())) {
            return s.M.front();
        }
        if (t >= s.t.back()) {
            return s.M.back();
        }
        const std::size_t i = segment(t);
        if (holds()) return s.M[i];
        if (!s.slopes.empty()) return on_piece(piece_of(i), t, rest);
        return s.M[i] + (s.M[i + 1] - s.M[i]) * (((t - s.t[i]) + rest) / (s.t[i + 1] - s.t[i]));
    }
    double next_break(double t) const {
        const std::vector<double>& times = samples->t;
        if (times.size() == 1) return never;
        if (samples->period) return later(t, piece(t).to);
        if (t >= times.back()) return never;
        return t < times.front() ? times.front() : times[segment(t) + 1];
    }
    double constant_from() const {
        if (samples->t.size() == 1) return -never;
        if (samples->period) return never;
        return samples->t.back();
    }
    double most() const { return most_; }
    double repeats_after() const { return samples->period.value_or(0); }
    template <class Sum>
    void closed_form(double inside, Sum& sum) const {
        const Samples& s = *samples;
        if (!s.period && (!(inside >= s.t.front()) || inside >= s.t.back())) {
            sum.add_constant(value(inside));
            return;
        }
        const Piece now = s.period ? piece(inside) : piece_of(segment(inside));
        if (holds()) {
            sum.add_constant(s.M[now.first]);
        } else if (s.slopes.empty()) {
            sum.add_line(now.from, s.M[now.first], (s.M[now.second] - s.M[now.first]) / (now.to - now.from));
        } else {
            sum.add_powers(now.from, powers(now));
        }
    }
    void delay_by(double d);
    [[nodiscard]] std::optional<text::Error> complaint() const;
    std::string formula(double gain) const;

private:
    bool holds() const { return samples->interpolation == Interpolation::hold; }
    /// The interval between two neighbouring points.
    struct Piece {
        double from, to;
        std::size_t first, second;
    };
    Piece piece_of(std::size_t i) const { return {samples->t[i], samples->t[i + 1], i, i + 1}; }
    /// The piece of periodic samples that contains `at`; its ends are exactly the doubles returned as breaks.
    Piece piece(double at) const;
    /// The coefficients in powers of the time since the piece began.
    std::array<double, 4> powers(const Piece& now) const {
        const Samples& s = *samples;
        const double h = now.to - now.from, rise = (s.M[now.second] - s.M[now.first]) / h;
        const double a = s.slopes[now.first], b = s.slopes[now.second];
        return {s.M[now.first], a, (3 * rise - 2 * a - b) / h, (a + b - 2 * rise) / (h * h)};
    }
    double on_piece(const Piece& now, double t, double rest) const {
        const Samples& s = *samples;
        if (holds()) return s.M[now.first];
        const double d = (t - now.from) + rest;
        if (s.slopes.empty()) return s.M[now.first] + (s.M[now.second] - s.M[now.first]) * (d / (now.to - now.from));
        const std::array<double, 4> c = powers(now);
        return c[0] + d * (c[1] + d * (c[2] + d * c[3]));
    }
    /// Computes the slopes of a spline and drops a last point that repeats the first.
    static std::shared_ptr<const Samples> prepared(std::shared_ptr<const Samples> points);
    /// A bound of |M|: a spline lies within the hull of its control points.
    double greatest() const;

    /// The index i with t[i] <= at < t[i + 1], for times inside the table. The first guess assumes evenly spaced
    /// samples.
    std::size_t segment(double at) const {
        const std::vector<double>& t = samples->t;
        const double steps = static_cast<double>(t.size() - 1);
        const double guess = std::clamp(steps * fraction(at, t.front(), t.back()), 0.0, steps - 1);
        const auto i = static_cast<std::size_t>(guess);
        if (t[i] <= at && at < t[i + 1]) {
            return i;
        }
        return static_cast<std::size_t>(std::ranges::upper_bound(t, at) - t.begin()) - 1;
    }

    double most_;  // cached: every run needs it, and a record may be long
};

inline constexpr TermText Polyline::about{
    {"excitation.samples", "excitation.samples{ t = { 0, 1, 2 }, M = { 0, 3, 0 } }", samples_options},
    "Straight lines, a cubic spline or held values between points, from two columns of a CSV file or from two tables (or "
    "vectors). Outside the points the first and the last value hold, unless a period is given. time and value "
    "name or number the columns; by default t (or time) and M, otherwise the first and the second column. Each "
    "point is a break.",
    "M = excitation.samples{ t = { 0, 1, 3 }, M = { 0, 2, 0 } }\nprint(M(0.5), M(2), M(9))  --> 1.0\t1.0\t0.0\n"
    "M = excitation.samples{ t = { 0, 1, 2, 3 }, M = { 0, 1, 0, -1 }, interpolation = \"cubic\", period = 4 }\n"
    "print(M(0.5), M(4.5))  --> 0.6875\t0.6875\n"
    "M = excitation.samples{ t = { 0, 1, 2 }, M = { 5, 7, 6 }, interpolation = \"hold\" }\n"
    "print(M(0.9), M(1), M(9))  --> 5.0\t7.0\t6.0"};

/// The cubic spline through points is given by its slopes there; its first two derivatives are continuous. These are
/// the slopes at increasing times. The third derivative is also continuous at the second point and the last but one
/// (not-a-knot, C. de Boor); three points give a parabola, two a straight line.
std::vector<double> spline_slopes(std::span<const double> t, std::span<const double> values);

/// The slopes of a periodic spline. The period must exceed the span of the times.
std::vector<double> periodic_spline_slopes(std::span<const double> t, std::span<const double> values, double period);

}  // namespace dinal::model::terms
