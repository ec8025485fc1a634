// The zero at which a watched value passes 0, also on pieces that no series resolves.
#include "motion/engine/crossing.hpp"

#include <cmath>

#include "support/catch.hpp"

namespace dinal::crossing_test {

namespace {

using namespace dinal::motion::engine;

template <class F>
std::optional<double> leaves(const F& value, Half half, double rounded = 0) {
    Nodes values{};
    for (std::size_t j = 0; j < node_count; ++j) values[j] = value(cheb::nodes[j]);
    return Watched(values, value, rounded).leaves(half, -1);
}

}  // namespace

TEST_CASE("a value that begins beyond zero within its rounding, and moves on, has passed it at the beginning") {
    // Its kink keeps the series from telling anything.
    const auto kinked = [](double x) { return -1e-17 - (1 + x) * (1 + std::fabs(x - 0.21)); };
    REQUIRE(leaves(kinked, 1).has_value());
    CHECK(*leaves(kinked, 1) < -1 + 1e-9);
    const auto smooth = [](double x) { return -1e-17 - (1 + x); };
    CHECK(leaves(smooth, 1) == -1.0);
}

TEST_CASE("a value that stays at zero for a while passes it at the end of that time") {
    const auto late = [](double x) { return x < 0.37 ? -1e-17 : 0.37 - x; };
    REQUIRE(leaves(late, 1, 1e-16).has_value());
    CHECK(std::fabs(*leaves(late, 1, 1e-16) - 0.37) < 1e-9);
}

TEST_CASE("a value that begins beyond zero within its rounding, and returns, has not passed it") {
    const auto back = [](double x) { return -1e-17 + (1 + x) * (1 + std::fabs(x - 0.21)); };
    CHECK_FALSE(leaves(back, 1).has_value());
}

TEST_CASE("a zero just after the one at which a curve begins is found") {
    // A bounce of 1e-7 of a stretch: the curve is below its own rounding between both.
    const auto always = [](double) { return true; };
    for (const double length : {1e-7, 1e-5, 1e-3}) {
        CAPTURE(length);
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) {
            const double x = 1 + cheb::nodes[j];
            values[j] = x * (length - x) * (1 + 0.3 * std::sin(x));
        }
        const Series series = cheb::fit(values);
        const cheb::Bounded<node_count> curve(1, series, cheb::derivative(series), values);
        const auto zero = cheb::first_below(curve, -1, true, always);
        REQUIRE(zero.has_value());
        CHECK(std::fabs(*zero + 1 - length) < 1e-13);
    }
}

}  // namespace dinal::crossing_test
