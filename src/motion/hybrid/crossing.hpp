// The first place on a piece where a value that somebody watches passes zero.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "motion/hybrid/solver.hpp"
#include "motion/interpolation.hpp"
#include "motion/spectral/first_below.hpp"

namespace dinal::motion::hybrid {

/// Which side of zero a watched value was on: 1 above, -1 below, 0 not known, because it stood at zero.
using Half = int;

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

/// A watched value on a piece: at its nodes, and anywhere.
template <class F>
class Watched {
public:
    /// What is not beyond `rounded` may be zero.
    Watched(const Nodes& values, const F& exact, double rounded = 0)
        : values_(values), exact_(exact), rounded_(rounded), series_(spectral::chebyshev::fit(values)) {
        constexpr double few = 64;
        size_ = spectral::chebyshev::size(series_);
        floor_ = std::max(few * rounding * size_, rounded);
        smooth_ = spectral::chebyshev::tail(series_) <= 1e-9 * size_;
    }
    /// The first x after `from` at which it leaves the half that it is in; that is looked up when it is not known.
    [[nodiscard]] std::optional<double> leaves(Half& half, double from) const {
        const bool at_zero = half == 0 || std::fabs(from == -1 ? values_[0] : exact_(from)) <= floor_;
        if (half == 0) {
            for (std::size_t j = 0; j < node_count && half == 0; ++j) {
                if (spectral::chebyshev::nodes[j] >= from) half = half_of(values_[j], 0);
            }
            if (half == 0) return {};
        }
        return smooth_ ? of_series(half, from, at_zero) : of_values(half, from);
    }

private:
    [[nodiscard]] Half half_of(double value, Half otherwise) const {
        return value > floor_ ? 1 : value < -floor_ ? -1 : otherwise;
    }
    [[nodiscard]] std::optional<double> of_series(Half half, double from, bool at_zero) const {
        using namespace spectral::chebyshev;
        Bounded<points> curve(half, series_, derivative(series_));
        curve.raise_floor(rounded_);
        const auto no = [](double) { return false; };
        const auto x = first_below(curve, from, at_zero ? LeftEnd::leaving : LeftEnd::anywhere, no);
        if (!x) return {};
        if (at_zero && *x <= from) return from;  // it stood at zero, and now goes where it was not
        // The series is right to some digits less than the value itself.
        constexpr double near = 1e-7;
        const double a = std::max(from, *x - near), b = std::min(1.0, *x + near);
        return refined(half, a, b).value_or(*x);
    }
    [[nodiscard]] std::optional<double> of_values(Half half, double from) const {
        constexpr int parts = 4;
        double a = from;
        for (std::size_t j = 1; j < node_count; ++j) {
            const double end = spectral::chebyshev::nodes[j];
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
        return first_positive(beyond, a, fa, b, fb, 1e-16).second;
    }

    const Nodes& values_;
    const F& exact_;
    double rounded_;
    Series series_;
    double size_ = 0, floor_ = 0;
    bool smooth_ = false;
};

}  // namespace dinal::motion::hybrid
