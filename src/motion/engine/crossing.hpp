// The first place on a piece where a value that somebody watches passes zero.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "model/terms/term.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/first_below.hpp"
#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

/// Which side of zero a watched value was on: 1 above, -1 below, 0 not known, because it stood at zero.
using Half = int;

/// What a user throws back each time sooner than before, until that is next to nothing: it has no end.
struct Fading {
    double last = -model::never, gap = model::never, first = 0;
    bool after(double t) {
        constexpr double next_to_nothing = 1e-5;
        const double now = t - last;
        if (!(now < gap) || gap == model::never) first = now;
        last = t, gap = now;
        return now < first && now <= next_to_nothing * first;
    }
};

/// An event of the user's, from one act to the next.
struct Watch {
    Half half = 0;
    Fading fading = {};
    double rounded = 0;      ///< what is zero of its values, since an act
    bool sent_back = false;  ///< by an act, and not clearly there yet
};

/// Where between -1 and x a condition that holds at x begins to hold, if it holds from there on: by halving.
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

/// Whether a series times this sign is clearly positive all over a piece, as most are: its other terms are less than
/// the constant one. It may be a difference of values of this size.
inline bool stays_above_zero(double sign, const Series& series, double of_size = 0) {
    constexpr double few = 64;
    const double all = cheb::size(series), others = all - std::fabs(series[0]);
    return sign * series[0] - others > few * rounding * std::max(all, of_size);
}

/// A watched value on a piece: at its nodes, and anywhere.
template <class F>
class Watched {
public:
    /// What is not beyond `rounded` may be zero.
    Watched(const Nodes& values, const F& exact, double rounded = 0)
        : values_(values), exact_(exact), rounded_(rounded), series_(cheb::fit(values)) {
        constexpr double few = 64;
        size_ = cheb::size(series_);
        floor_ = std::max(few * rounding * size_, rounded);
        smooth_ = cheb::tail(series_) <= 1e-9 * size_;
    }
    /// The first x after `from` at which it leaves the half that it is in; that is looked up when it is not known.
    [[nodiscard]] std::optional<double> leaves(Half& half, double from) const {
        const bool at_zero = half == 0 || std::fabs(from == -1 ? values_[0] : exact_(from)) <= floor_;
        if (half == 0) {
            for (std::size_t j = 0; j < node_count && half == 0; ++j) {
                if (cheb::nodes[j] >= from) half = half_of(values_[j], 0);
            }
            if (half == 0) return {};
        }
        // What an impact has put on the other side, farther than roundings of time do, has passed zero on the way.
        constexpr double clearly = 1e-9;
        if (from == -1 && half * values_[0] < -std::max(floor_, clearly * size_)) return from;
        if (!at_zero) return smooth_ ? of_series(half, from) : of_values(half, from);
        // Outwards from within the rounding, until it is clear which way it goes.
        double d = 0x1p-46;
        while (from + d < 1 && std::fabs(exact_(from + d)) <= floor_) d *= 2;
        const double start = std::min(1.0, from + d);
        const auto is_beyond = [&](double x) { return half_of(exact_(x), half) != half; };
        if (!is_beyond(start)) return smooth_ ? of_series(half, start) : of_values(half, start);
        return smooth_ ? from : first_true(is_beyond, start);  // it may have stood at zero for long
    }

    /// Whether it is beyond rounding in this half somewhere before x: at a node, or half way to x.
    [[nodiscard]] bool is_clearly(Half half, double x) const {
        if (!(x > -1)) return false;
        for (std::size_t j = 0; j < node_count; ++j) {
            if (cheb::nodes[j] <= x && half_of(values_[j], 0) == half) return true;
        }
        return half_of(exact_((x - 1) / 2), 0) == half;
    }

private:
    [[nodiscard]] Half half_of(double value, Half otherwise) const {
        return value > floor_ ? 1 : value < -floor_ ? -1 : otherwise;
    }
    /// The series says where to look, and is right to some digits less than the value itself, which says what is there.
    [[nodiscard]] std::optional<double> of_series(Half half, double start) const {
        using namespace cheb;
        Bounded<points> curve(half, series_, derivative(series_));
        curve.raise_floor(rounded_);
        const auto no = [](double) { return false; };
        double near = 1e-7;
        while (start < 1) {
            const auto x = first_below(curve, start, LeftEnd::anywhere, no);
            if (!x) break;
            double a = std::max(start, *x - near);
            while (a > start && half * exact_(a) < -rounded_) a = std::max(start, *x - (near *= 2));
            if (half * exact_(a) < -rounded_) return a;  // it has been there before
            const double b = std::min(1.0, *x + near);
            if (const auto zero = refined(half, a, b)) return zero;
            start = b;
            near *= 2;
        }
        return {};
    }
    [[nodiscard]] std::optional<double> of_values(Half half, double from) const {
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
    /// The zero between a and b when they are on both sides of it.
    [[nodiscard]] std::optional<double> refined(Half half, double a, double b) const {
        const auto beyond = [&](double x) { return -half * exact_(x); };
        const double fa = beyond(a), fb = beyond(b);
        if (!(fa <= rounded_ && fb > rounded_)) return {};
        if (fa > 0) return a;
        const auto [zero, passed] = first_positive(beyond, a, fa, b, fb, 1e-16);
        return beyond(zero) == 0 ? zero : passed;
    }

    const Nodes& values_;
    const F& exact_;
    double rounded_;
    Series series_;
    double size_ = 0, floor_ = 0;
    bool smooth_ = false;
};

}  // namespace dinal::motion::engine
