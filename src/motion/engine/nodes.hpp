// The nodes of a stretch of motion, and the evaluation of user functions on one side of a jump.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/chebyshev.hpp"

namespace dinal::motion::engine {

namespace cheb = chebyshev;
using Nodes = cheb::Samples;
using Series = cheb::Series<cheb::points>;
inline constexpr std::size_t node_count = cheb::points;
inline constexpr double rounding = std::numeric_limits<double>::epsilon();
inline constexpr double smallest = std::numeric_limits<double>::min() / rounding;  // smaller numbers lose digits

inline double greatest(const Nodes& values) {
    double most = 0;
    for (const double x : values) most = std::max(most, std::fabs(x));
    return most;
}

inline Series difference(const Series& a, const Series& b) {
    Series c{};
    for (std::size_t k = 0; k < node_count; ++k) c[k] = a[k] - b[k];
    return c;
}

inline void add(Nodes& sum, const Nodes& values, double by) {
    for (std::size_t k = 0; k < node_count; ++k) sum[k] += by * values[k];
}

/// The side of a break: the limits from the left and from the right differ.
enum class Side { before, at, after };

/// The times of a stretch's nodes.
struct NodeTimes {
    Nodes times{}, rests{};  ///< times, and their rounding errors
    double h = 0;            ///< half the length of the stretch
    bool from_break = false, to_break = false;

    Side side(std::size_t node) const {
        return node == 0 && from_break ? Side::after : node + 1 == node_count && to_break ? Side::before : Side::at;
    }
};

/// Returns t, moved to this side by a step that survives rounding in a user's arithmetic (see model/excitation.cpp).
inline double towards(double t, Side side) {
    constexpr double few_ulps = 4 * std::numeric_limits<double>::epsilon();
    const double hair = std::max(1e-300, few_ulps * std::fabs(t));
    return side == Side::before ? t - hair : side == Side::after ? t + hair : t;
}

/// Rounds a half length down to one of a few steps, for which matrices are cached.
inline double rung(double h, double longest) {
    constexpr double rungs = 4;  // steps per factor of two
    return h >= longest ? longest : longest * std::exp2(std::floor(rungs * std::log2(h / longest)) / rungs);
}

/// A bound of the error of a series from the rounding of times far from t = 0. For a jump the error is limited to its
/// height.
inline double lost_in_time(const Series& series, double late, double h, double most) {
    double slope = 0;
    for (std::size_t k = 1; k < node_count; ++k) slope += static_cast<double>(k * k) * std::fabs(series[k]);
    return std::min(4 * rounding * late / h * slope, 1e-6 * most);
}

}  // namespace dinal::motion::engine
