// The first zero of a curve on a panel: where it is, and how often the curve is asked.
#include "motion/spectral/first_below.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "support/catch.hpp"

namespace dinal::first_below_test {

using namespace dinal::motion::spectral;

namespace {

/// Falls through its zero; each value is off by up to half of `noise`, at random but always the same.
struct FallingCurve {
    double zero, slope_there, noise;
    mutable int asked = 0;

    [[nodiscard]] double operator()(double x) const {
        ++asked;
        auto bits = std::bit_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U;
        bits ^= bits >> 29U;
        bits *= 0xBF58476D1CE4E5B9U;
        const double chance = static_cast<double>(bits >> 11U) * 0x1p-53 - 0.5, off = x - zero;
        return slope_there * off * (1 + 0.3 * off) + noise * chance;
    }
    [[nodiscard]] double slope(double x) const { return slope_there * (1 + 0.6 * (x - zero)); }
    [[nodiscard]] double second_bound() const { return std::fabs(0.6 * slope_there); }
};

}  // namespace

TEST_CASE("a zero is polished in a few looks, to what the noise of the curve lets be known",
          "[spectral][first_below]") {
    for (const double slope : {-1.0, -0.01}) {
        for (const double noise : {0.0, 1e-16, 1e-14}) {
            for (int i = 0; i < 500; ++i) {
                const double zero = 0.1 + 0.0016 * i, a = 0.9 * zero, b = std::min(1.0, 1.3 * zero);
                const FallingCurve f{zero, slope, noise};
                const double fa = f(a), fb = f(b);
                f.asked = 0;
                const double x = chebyshev::detail::polish(f, a, fa, b, fb);
                CAPTURE(slope, noise, zero);
                REQUIRE(f.asked <= 4);  // the error of the chord, here up to 0.01, is squared each time
                // Half of the noise over the least slope on the way there, and the rounding of a sum.
                REQUIRE(std::fabs(x - zero) <= 0.6 * noise / -slope + 4e-16);
            }
        }
    }
}

TEST_CASE("a curve that leaves zero comes back to it where it does, however soon", "[spectral][first_below]") {
    using namespace chebyshev;
    constexpr std::size_t n = points + 1;
    const double pi = std::acos(-1.0);
    for (const int power : {1, 2}) {
        for (const double ripple : {0.0, 0.3, -0.9, 1.5}) {
            for (int i = 1; i < 200; ++i) {
                // (1 + x)^p (zero - x) and a factor that does not change its sign: e^(ripple x).
                const double zero = -1 + 2 * std::pow(0.005 * i, 3);
                const auto f = [&](double x) { return std::pow(1 + x, power) * (zero - x) * std::exp(ripple * x); };
                Series<n> c{};
                constexpr std::size_t many = 64;
                for (std::size_t k = 0; k < n; ++k) {
                    for (std::size_t j = 0; j < many; ++j) {
                        const double angle = pi * (static_cast<double>(j) + 0.5) / many;
                        c[k] +=
                            (k == 0 ? 1.0 : 2.0) / many * f(std::cos(angle)) * std::cos(static_cast<double>(k) * angle);
                    }
                }
                const Bounded<n> curve(1, c, derivative(c));
                const double highest =
                    std::pow(1 + zero, power + 1) * (power == 1 ? 0.25 : 4.0 / 27) * std::exp(-std::fabs(ripple));
                if (highest <= 2 * curve.floor()) continue;  // then it may as well not have left
                const double reach = curve.leaves_upward();
                CAPTURE(power, ripple, zero, reach);
                // Its coefficients are rounded, which moves a zero by that over its slope there.
                const double slope = std::pow(1 + zero, power) * std::exp(ripple * zero);
                const double off = 64 * 2.2e-16 * size(c) / slope + 4e-16;
                // It is positive as far as it says, which is some of the way, so that something is said.
                REQUIRE(-1 + reach <= zero + off);
                if (ripple == 0 && power == 1) REQUIRE(reach > 0.2 * (1 + zero));
                const auto never = [](double) { return false; };
                const auto x = first_below(curve, -1, LeftEnd::leaving, never);
                REQUIRE(x.has_value());
                REQUIRE(std::fabs(*x - zero) <= off);
            }
        }
    }
}

}  // namespace dinal::first_below_test
