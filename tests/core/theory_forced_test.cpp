// Closed forms of steady motion without dry friction, and of friction taken for viscous.
#include "theory/forced.hpp"

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "support/catch.hpp"

namespace dinal::theory_forced_test {

using namespace dinal::theory;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("magnification and lag solve the equation of motion", "[theory]") {
    using Complex = std::complex<double>;
    for (const double zeta : {0.0, 0.02, 0.119, 0.7, 1.0, 3.0}) {
        for (const double r : {0.0, 0.1, 0.9, 1.1, 2.0, 50.0}) {
            const Complex answer = 1.0 / Complex(1 - r * r, 2 * zeta * r);
            CAPTURE(zeta, r);
            CHECK(magnification(r, zeta) == Approx(std::abs(answer)).epsilon(1e-14));
            CHECK(phase_lag(r, zeta) == Approx(std::abs(std::arg(answer))).epsilon(1e-14));
        }
    }
}

TEST_CASE("near resonance the magnification keeps its digits, and at resonance it has its limits", "[theory]") {
    const double r = 1 + 0x1p-40;
    CHECK(magnification(r, 0) == Approx(0x1p39).epsilon(1e-12 + 1e-15));  // 1/(2e + e^2)
    CHECK(magnification(1, 0.239) == Approx(2.0920502).epsilon(1e-7));    // figure 19
    CHECK(magnification(1, 0) == infinite);
    CHECK(phase_lag(1, 0) == pi / 2);
    CHECK(phase_lag(1, 0.3) == pi / 2);
    CHECK(phase_lag(0.99, 0) == 0);
    CHECK(phase_lag(1.01, 0) == Approx(pi));
}

TEST_CASE("figure 25: linearised friction gives an amplitude 8.9 % too great, zeta = 0.242 one 10.6 % too great",
          "[theory]") {
    const auto motion = linearised_friction(1.35, 0, 0.5);
    REQUIRE(motion);
    const double truth = 0.860792180;
    CHECK(std::fabs(motion->amplitude - 0.9376) <= 0.00005);
    CHECK(std::fabs(motion->amplitude / truth - 1.089) <= 0.0005);
    CHECK(std::fabs(magnification(1.35, 0.242) - 0.9520) <= 0.00005);
    CHECK(std::fabs(magnification(1.35, 0.242) / truth - 1.106) <= 0.0005);
    CHECK(std::fabs(phase_lag(1.35, 0.242) * 180 / pi - 141.54) <= 0.005);
}

TEST_CASE("the motion with linearised friction is the one that its equivalent damping gives", "[theory]") {
    for (const double zeta : {0.0, 0.05, 0.8}) {
        for (const double r : {0.2, 0.95, 1.0, 1.05, 4.0}) {
            const double gamma = 0.3;
            if (zeta == 0 && r == 1) continue;
            const auto motion = linearised_friction(r, zeta, gamma);
            REQUIRE(motion);
            // In a cycle a dashpot takes pi C omega X^2, dry friction 4 Rd X.
            const double all = zeta + 2 * gamma / (pi * r * motion->amplitude);
            CAPTURE(zeta, r);
            CHECK(motion->amplitude == Approx(magnification(r, all)).epsilon(1e-13));
            CHECK(motion->lag == Approx(phase_lag(r, all)).epsilon(1e-13));
            if (zeta == 0) {
                const double report = std::sqrt(1 - std::pow(4 * gamma / pi, 2)) / std::fabs(1 - r * r);
                CHECK(motion->amplitude == Approx(report).epsilon(1e-13));
            }
        }
    }
    CHECK(linearised_friction(1, 0, 0.5)->amplitude == infinite);
    CHECK_FALSE(linearised_friction(1.35, 0, pi / 4));
    CHECK_FALSE(linearised_friction(1.35, 0.3, 2));
}

}  // namespace dinal::theory_forced_test
