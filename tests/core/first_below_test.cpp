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

}  // namespace dinal::first_below_test
