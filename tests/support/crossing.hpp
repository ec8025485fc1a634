// Zeros and minima of functions in long double, by Boost.Math, for the oracles.
#pragma once

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

namespace dinal::truth {

constexpr std::uintmax_t most_tries = 200;  // bisection needs one for each bit

/// Requires opposite signs of f at a and b (or zero at b); returns the first number on the side of b.
template <class F>
long double crossing(const F& f, long double a, long double b) {
    std::uintmax_t tries = most_tries;
    return boost::math::tools::bisect(
               f, a, b, [](long double, long double) { return false; }, tries)
        .second;
}

/// The same to 1e-18 for a smooth f that is expensive; fa and fb are its values at the ends.
template <class F>
long double smooth_crossing(const F& f, long double a, long double fa, long double b, long double fb) {
    std::uintmax_t tries = most_tries;
    const auto close = [](long double x, long double y) { return std::fabs(y - x) < 1e-18L; };
    return fb == 0 ? b : boost::math::tools::toms748_solve(f, a, b, fa, fb, close, tries).second;
}

/// The minimum of f between a and b.
template <class F>
long double least(const F& f, long double a, long double b) {
    constexpr int bits = 64;  // half of them are attainable, as f is flat there
    return boost::math::tools::brent_find_minima(f, a, b, bits).first;
}

}  // namespace dinal::truth
