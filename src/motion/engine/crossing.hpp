// Finds the first zero of a watched value on a piece of the motion.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "motion/engine/chatter.hpp"
#include "motion/first_below.hpp"
#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

/// The side of zero of a watched value: 1 above, -1 below, 0 unknown, because it started at zero.
using Half = int;

/// The state of a user's event between its actions.
struct Watch {
    Half half = 0;
    Fading fading = {};
    double rounded = 0;      ///< values up to this size count as zero after an action
    bool sent_back = false;  ///< whether an action put it back on its old side, which it has not clearly reached
};

/// The point in [-1, x] from which a condition that holds at x holds without interruption, by bisection.
template <class Condition>
double first_true(const Condition& holds, double x) {
    constexpr double finest = 1e-15;
    double before = x, from = x;
    double step = 1e-9;
    while (before == from) {
        if (from <= -1) return -1;
        before = std::max(-1.0, from - step);
        if (holds(before)) from = before;
        step *= 2;
    }
    while (from - before > finest) {
        const double middle = before + (from - before) / 2;
        (holds(middle) ? from : before) = middle;
    }
    return from;
}

/// Returns whether sign * series is certainly positive on the whole piece: its constant term exceeds the sum of the
/// others. `of_size` is the magnitude of the numbers whose difference the series is.
inline bool stays_above_zero(double sign, const Series& series, double of_size = 0) {
    constexpr double few = 64;
    const double all = cheb::size(series), others = all - std::fabs(series[0]);
    return sign * series[0] - others > few * rounding * std::max(all, of_size);
}

/// A watched value on a piece: its values at the nodes, and a function for any point.
template <class F>
class Watched {
public:
    /// Values up to `rounded` count as zero.
    Watched(const Nodes& values, const F& exact, double rounded = 0)
        : Watched(values, exact, rounded, cheb::fit(values), 0) {}
    /// Uses a given series, which is slightly less accurate than the function.
    Watched(const Nodes& values, const F& exact, double rounded, const Series& series)
        : Watched(values, exact, rounded, series, 1e-13) {}
    /// The first x after `from` at which the value leaves this half; an unknown half is set from the nodes.
    std::optional<double> leaves(Half& half, double from) const {
        const bool at_zero = half == 0 || std::fabs(from == -1 ? values_[0] : exact_(from)) <= floor_;
        if (half == 0) {
            for (std::size_t j = 0; j < node_count && half == 0; ++j) {
                if (cheb::nodes[j] >= from) half = half_of(values_[j], 0);
            }
            if (half == 0) return {};
        }
        // An impact has put the value on the other side by more than rounding, so its zero is in the past.
        constexpr double clearly = 1e-9;
        if (from == -1 && half * values_[0] < -std::max(floor_, clearly * size_)) return from;
        if (!at_zero) return smooth_ ? of_series(half, from) : of_values(half, from);
        // Moves away from `from` until the value exceeds rounding. Unlike in first_below(), a zero at the start is not
        // divided out, because the function may have no series.
        double d = 0x1p-46;
        while (from + d < 1 && std::fabs(exact_(from + d)) <= floor_) d *= 2;
        const double start = std::min(1.0, from + d);
        const auto is_beyond = [&](double x) { return half_of(exact_(x), half) != half; };
        if (!is_beyond(start)) return smooth_ ? of_series(half, start) : of_values(half, start);
        return smooth_ ? from : first_true(is_beyond, start);  // the value may have been zero for long
    }

    /// Returns whether the value is clearly in this half before x, at a node or halfway to x.
    bool is_clearly(Half half, double x) const {
        if (!(x > -1)) return false;
        for (std::size_t j = 0; j < node_count; ++j) {
            if (cheb::nodes[j] <= x && half_of(values_[j], 0) == half) return true;
        }
        return half_of(exact_((x - 1) / 2), 0) == half;
    }

private:
    Watched(const Nodes& values, const F& exact, double rounded, const Series& series, double usual)
        : values_(values), exact_(exact), rounded_(rounded), usual_(usual), series_(series) {
        constexpr double few = 64;
        size_ = cheb::size(series_);
        floor_ = std::max(few * rounding * size_, rounded);
        smooth_ = is_smooth();
    }
    /// Returns whether the series has decayed, or still falls steeply at its end; a series of rounding errors stays
    /// level.
    bool is_smooth() const {
        constexpr double decayed = 1e-9, decaying = 1e-6, steeply = 64;
        const double tail = cheb::tail(series_);
        double earlier = 0;
        for (std::size_t k = node_count / 2; k < node_count - 5; ++k) {
            earlier = std::max(earlier, std::fabs(series_[k]));
        }
        return tail <= decayed * size_ || (tail <= decaying * size_ && earlier > steeply * tail);
    }
    Half half_of(double value, Half otherwise) const { return value > floor_ ? 1 : value < -floor_ ? -1 : otherwise; }
    struct Part {
        double middle = 0, half = 1;
        double place(double x) const { return middle + half * x; }
        double inside(double x) const { return (x - middle) / half; }
        double end() const { return middle + half; }
    };
    /// The first zero by the series. If a part of the series is below the error of the whole, such as a narrow window
    /// given by the square of a wide quantity, the function is fitted again on that part alone.
    std::optional<double> of_series(Half half, double start) const {
        using namespace cheb;
        constexpr double few = 64;
        double least = 1e-10;  // length of a part; grows, as a series that stays near its error would have many parts
        const double error = few * tail(series_);
        if (error <= floor_) return of_series(half, start, {}, series_, values_);
        const auto raised = [&](double sign, double by) {
            Series moved = series_;
            moved[0] += half * by;
            return Bounded<points>(sign * half, moved, derivative(moved));
        };
        const auto clear = raised(1, -error), unclear = raised(-1, -error), passed = raised(1, error);
        while (start < 1) {
            const auto from = first_below(clear, start);
            if (!from) break;
            const double first = std::max(start, *from), inside = std::min(1.0, first + least);
            const auto back = first_below(unclear, inside), through = first_below(passed, inside);
            const double last = std::min({1.0, back.value_or(1), through.value_or(1)});
            const Part part{(first + last) / 2, (last - first) / 2};
            Nodes values;
            for (std::size_t j = 0; j < node_count; ++j) values[j] = exact_(part.place(nodes[j]));
            if (const auto x = of_series(half, first, part, fit(values), values)) return x;
            if (const auto x = refined(half, first, last)) return x;
            start = last;
            least *= 4;
        }
        return {};
    }
    /// Finds candidate zeros by the series of a part; the function itself, which has more digits, decides.
    std::optional<double> of_series(Half half, double start, const Part& part, const Series& series,
                                    Nodes values) const {
        using namespace cheb;
        for (double& each : values) each *= half;
        Bounded<points> curve(half, series, derivative(series), values);
        curve.raise_floor(rounded_);
        double near = 1e-7 * part.half, low = start;  // at `low` the value is still in its half
        while (start < part.end()) {
            const auto found = first_below(curve, std::max(-1.0, part.inside(start)));
            if (!found) break;
            const double x = part.place(*found);
            if (usual_ > 0) {
                const auto zero = refined(half, std::max(low, x - usual_), std::min(part.end(), x + usual_));
                if (zero) return zero;
            }
            double a = std::max(low, x - near);
            while (a > low && half * exact_(a) < 0) a = std::max(low, x - (near *= 2));
            if (half * exact_(a) < -rounded_) return a;  // the value was below zero earlier
            const double b = std::min(part.end(), x + near);
            if (const auto zero = refined(half, a, b)) return zero;
            start = b;
            if (half * exact_(b) >= 0) low = b;
            near *= 2;
        }
        return {};
    }
    std::optional<double> of_values(Half half, double from) const {
        constexpr int parts = 4;
        double a = from;
        for (std::size_t j = 1; j < node_count; ++j) {
            const double end = cheb::nodes[j];
            if (end <= from) continue;
            const double begin = a;
            for (int part = 1; part <= parts; ++part) {
                const double b = part == parts ? end : begin + (end - begin) * part / parts;
                if (const auto x = refined(half, a, b)) return x;
                a = b;
            }
        }
        return {};
    }
    /// The zero between a and b if they are on opposite sides.
    std::optional<double> refined(Half half, double a, double b) const {
        const auto beyond = [&](double x) { return -half * exact_(x); };
        const double fa = beyond(a), fb = beyond(b);
        if (!(fa <= rounded_ && fb > rounded_)) return {};
        if (fa > 0) return a;
        const auto [zero, passed] = first_positive(beyond, a, fa, b, fb, 1e-16);
        return beyond(zero) == 0 ? zero : passed;
    }

    const Nodes& values_;
    const F& exact_;
    /// values up to `rounded_` count as zero; within `usual_` of a zero of the series, the function decides
    double rounded_, usual_;
    Series series_;
    double size_ = 0, floor_ = 0;
    bool smooth_ = false;
};

}  // namespace dinal::motion::engine
