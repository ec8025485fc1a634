// Finds the first point at which a polynomial on a panel falls below zero, proves that it is the first, and polishes it
// to rounding.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "motion/chebyshev.hpp"

namespace dinal::motion::chebyshev {

/// A polynomial, its derivative, and bounds that prove the absence of zeros between two values.
template <std::size_t n>
class Bounded {
public:
    /// `sign` * f; `slope` is the derivative of f.
    Bounded(double sign, const Series<n>& f, const Series<n - 1>& slope) : Bounded(sign, f, slope, {}) {
        at_nodes_ = chebyshev::at_nodes(f_);
    }
    /// Uses these values of f at the nodes instead of computing them.
    Bounded(double sign, const Series<n>& f, const Series<n - 1>& slope, const Samples& at_nodes)
        : f_(f), slope_(slope), at_nodes_(at_nodes) {
        for (double& c : f_) c *= sign;
        for (double& c : slope_) c *= sign;
        second_ = derivative_bound<2>(f_);
        floor_ = rounding * size(f_);
        slope_floor_ = rounding * size(slope_);
    }
    [[nodiscard]] double operator()(double x) const { return value(f_, x); }
    double slope(double x) const { return value(slope_, x); }
    double second_bound() const { return second_; }
    /// An upper bound of how far the curve sags below its chord over this width.
    double dip(double width) const { return second_ * width * width / 8; }
    /// Returns whether the curve between these two values, `width` apart, is positive.
    bool stays_above(double a, double b, double width) const { return std::min(a, b) > dip(width); }
    /// The rounding error of a value.
    double floor() const { return floor_; }
    /// Raise the rounding error of values or slopes, for a curve that is a difference of larger numbers.
    void raise_floor(double least) { floor_ = std::max(floor_, least); }
    void raise_slope_floor(double least) { slope_floor_ = std::max(slope_floor_, least); }
    /// The lowest point around x if the curve touches zero within rounding without clearly crossing it.
    double lowest_near(double x) const {
        const double reach = second_ > 0 ? 2 * std::sqrt(8 * floor_ / second_) : 0;
        double a = std::max(-1.0, x - reach), b = std::min(1.0, x + reach);
        if (!(slope(a) < -slope_floor_ && slope(b) > slope_floor_)) return x;
        for (int i = 0; i < 60; ++i) {
            const double middle = a + (b - a) / 2;
            if (!(middle > a && middle < b)) break;
            (slope(middle) < 0 ? a : b) = middle;
        }
        return b;
    }
    const Samples& at_nodes() const { return at_nodes_; }
    /// The distance from -1 up to which a curve that leaves zero there is certainly positive: by its slope, or if that
    /// is also zero, by its curvature. 0 if neither decides.
    double leaves_upward() const {
        double at_left = 0, bend = 0;
        for (std::size_t k = 0; k + 1 < n; ++k) at_left += k % 2 == 0 ? slope_[k] : -slope_[k];
        const double by_slope = at_left > 0 ? 2 * at_left / second_ : 0;
        for (std::size_t k = 2; k < n; ++k) {
            const auto k2 = static_cast<double>(k * k);
            bend += (k % 2 == 0 ? f_[k] : -f_[k]) * (k2 * (k2 - 1) / 3);
        }
        // A dip below zero that is no deeper than the rounding does not count.
        if (at_left < -slope_floor_ && !(at_left * at_left <= 2 * bend * floor_)) return 0;
        const double by_bend = bend > 0 ? 3 * bend / derivative_bound<3>(f_) : 0;
        return by_slope > by_bend ? by_slope : by_bend;  // false for NaN
    }

    /// The curve divided by 1 + x. Requires f(-1) = 0; its other zeros remain. The rounding error near -1 is about that
    /// of a slope, farther away more than that of f.
    Bounded divided() const {
        constexpr double nearest = 32;  // factor by which the division enlarges the rounding of values
        Series<n> quotient{};
        for (std::size_t k = n - 1; k > 0; --k) {
            quotient[k - 1] = 2 * (f_[k] - quotient[k]) - (k + 1 < n ? quotient[k + 1] : 0);
        }
        quotient[0] /= 2;
        Bounded divided(1, quotient, derivative(quotient), at_nodes_);
        divided.at_nodes_[0] = slope(-1);
        for (std::size_t j = 1; j < points; ++j) divided.at_nodes_[j] /= 1 + nodes[j];
        divided.floor_ = std::max(slope_floor_, nearest * floor_);
        return divided;
    }

private:
    static constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();

    Series<n> f_;
    Series<n - 1> slope_;
    Samples at_nodes_{};
    double second_ = 0;
    double floor_ = 0, slope_floor_ = 0;
};

namespace detail {

/// The zero between f(a) > 0 and f(b) <= 0 of a falling curve: Newton within the bracket, until a step is below
/// rounding.
template <class F>
double polish(const F& f, double a, double fa, double b, double fb) {
    constexpr double rounding = 2e-16;
    double x = a + (b - a) * (fa / (fa - fb));
    for (int i = 0; i < 60; ++i) {
        const double fx = f(x), slope = f.slope(x);
        if (fx == 0) break;
        (fx > 0 ? a : b) = x;
        double next = a;
        if (slope < 0) {
            const double step = -fx / slope;
            next = x + step;
            if (step * step * f.second_bound() <= -2 * rounding * slope) return std::clamp(next, a, b);
        }
        if (!(next > a && next < b)) {
            if (b - a <= 2 * rounding) break;
            next = a + (b - a) / 2;
        }
        x = next;
    }
    return x;
}

template <class F, class Confirm>
std::optional<double> search(const F& f, double a, double fa, double b, double fb, const Confirm& confirm) {
    const double width = b - a;
    if (f.stays_above(fa, fb, width)) return {};
    const double middle = a + width / 2;
    if (const double slope = f.slope(middle); std::fabs(slope) > f.second_bound() * width / 2) {
        if (slope > 0 || fb > f.floor()) return {};
        if (fb < -f.floor()) return fa > 0 ? polish(f, a, fa, b, fb) : a;
        return confirm(b) ? std::optional(b) : std::nullopt;
    }
    if (!(f.dip(width) > f.floor()) || width < 1e-12) {  // true for NaN as well
        if (fb < -f.floor()) return fa > 0 ? polish(f, a, fa, b, fb) : a;
        const double lowest = fa < fb ? a : b;
        return std::min(fa, fb) <= f.floor() && confirm(lowest) ? std::optional(lowest) : std::nullopt;
    }
    const double fm = f(middle);
    if (const auto x = search(f, a, fa, middle, fm, confirm)) return x;
    return search(f, middle, fm, b, fb, confirm);
}

/// The first x in [-1, nodes[1]] at which f falls below zero if f(-1) = 0; -1 if it does so at once. The known zero is
/// divided out. At a double zero (a grazing motion) the quotient is also zero to rounding; then the first value of f
/// beyond rounding decides.
template <class F, class Confirm>
std::optional<double> behind_zero(const F& f, const Confirm& confirm) {
    const F divided = f.divided();
    const double first = divided.at_nodes()[0], right = nodes[1], f_right = f.at_nodes()[1];
    if (first < -divided.floor()) return -1;
    if (first > divided.floor()) return search(divided, -1, first, right, divided.at_nodes()[1], confirm);
    double d = (right + 1) * 0x1p-46;
    while (d < right + 1 && std::fabs(f(d - 1)) <= f.floor()) d *= 2;
    const double left = std::min(d - 1, right), f_left = f(left);
    if (f_left < -f.floor()) return -1;
    return right > left ? search(f, left, f_left, right, f_right, confirm) : std::nullopt;
}

}  // namespace detail

/// Curves that only touch zero do not count.
struct NoTouch {
    bool operator()(double /*x*/) const { return false; }
};

/// The first x in [from, 1] at which f falls below zero. If f touches zero within rounding without clearly crossing it,
/// confirm(x) decides whether that counts. If f(-1) is known to be `zero`, f should rise from there; otherwise the
/// result is -1. A bound of f'' proves that no zero lies between two values; otherwise the interval is halved, so that
/// pairs of close zeros are not missed.
template <class F, class Confirm = NoTouch>
std::optional<double> first_below(const F& f, double from, bool zero = false, const Confirm& confirm = {}) {
    const Samples& at_node = f.at_nodes();
    std::size_t j = 1;
    while (j < degree && nodes[j] <= from) ++j;
    double left = from;
    double f_left = from == -1 ? at_node[0] : f(from);
    if (zero) {
        const double far = f.leaves_upward();
        if (far >= nodes[1] + 1) {
            while (j < degree && nodes[j + 1] + 1 <= far) ++j;
        } else if (const auto x = detail::behind_zero(f, confirm)) {
            return x;
        }
        left = nodes[j], f_left = at_node[j], ++j;
        if (far >= nodes[1] + 1 && f_left <= 0) f_left = f.floor();  // positive and tiny
    }
    for (; j <= degree; ++j) {
        if (nodes[j] > left && !f.stays_above(f_left, at_node[j], nodes[j] - left)) {
            if (const auto x = detail::search(f, left, f_left, nodes[j], at_node[j], confirm)) return x;
        }
        left = nodes[j], f_left = at_node[j];
    }
    return {};
}

}  // namespace dinal::motion::chebyshev
