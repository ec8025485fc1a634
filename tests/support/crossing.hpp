// Where a function passes zero or is least, in long double: Boost.Math's searches as the oracles use them.
#pragma once

#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <cstdint>

namespace dinal::truth {

constexpr std::uintmax_t most_tries = 200;  // halving needs one for each bit

/// f has one sign at a and the other, or none, at b; the result is the first number that has come to the side of b.
template <class F>
long double crossing(const F& f, long double a, long double b) {
    std::uintmax_t tries = most_tries;
    return boost::math::tools::bisect(
               f, a, b, [](long double, long double) { return false; }, tries)
        .second;
}

/// The same to 1e-18, for an f that is smooth and costs something; fa and fb are its values at the ends.
template <class F>
long double smooth_crossing(const F& f, long double a, long double fa, long double b, long double fb) {
    std::uintmax_t tries = most_tries;
    const auto close = [](long double x, long double y) { return std::fabs(y - x) < 1e-18L; };
    return fb == 0 ? b : boost::math::tools::toms748_solve(f, a, b, fa, fb, close, tries).second;
}

/// Where f is least between a and b.
template <class F>
long double least(const F& f, long double a, long double b) {
    constexpr int bits = 64;  // half of them can be had: f is flat there
    return boost::math::tools::brent_find_minima(f, a, b, bits).first;
}

}  // namespace dinal::truth
