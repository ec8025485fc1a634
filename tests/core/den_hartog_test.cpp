// Den Hartog's motion and stop boundary against numbers of 80 digits, the balance of energy, and rk4.
#include "theory/forced.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::den_hartog_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::theory;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Case {
    double r, zeta, value;
};

double amplitude(double r, double gamma, double zeta = 0) {
    const auto motion = DenHartog(r, zeta).motion(gamma, gamma);
    return motion ? motion->amplitude : -1;
}

/// Starts at the peak of this motion, with the load where it is then, and runs `periods` of the load.
Run from_the_peak(const Oscillator& system, double r, const SlidingMotion& y, double periods) {
    const double omega = 2 * pi * r;
    return truth::must_run(system, truth::harmonic(1, omega, y.lag + pi / 2), {y.amplitude, 0}, {0, periods / r},
                           Grid::none(), Rk4{std::min(1.0, 1 / r) / 2000});
}

long sticks_since(const Run& run, double t) {
    return std::count_if(run.events.begin(), run.events.end(), [t](const Event& event) {
        return event.t > t && (event.kind == EventKind::stick || event.kind == EventKind::rest);
    });
}

}  // namespace

TEST_CASE("Den Hartog's amplitudes without viscous damping, to the digits printed", "[den_hartog]") {
    for (const Case& c : {Case{0.75, .5, 1.972601445}, Case{0.9, .5, 4.215903717}, Case{1.1, .5, 3.561050106},
                          Case{1.25, .3, 1.617064871}, Case{1.35, .5, 0.860792180}, Case{1.5, .5, 0.553774924},
                          Case{2, .5, 0.220479276}}) {
        CHECK(std::fabs(amplitude(c.r, c.zeta) - c.value) <= 0.51e-9);  // here the second number is gamma
    }
}

TEST_CASE("figure 27: with viscous damping the amplitude at resonance is 1.9611201772", "[den_hartog]") {
    CHECK(std::fabs(amplitude(1, 0.418, 0.119) - 1.9611201772) <= 0.51e-10);
}

TEST_CASE("figure 25: the fundamental lags 140.69 degrees, the peak another angle", "[den_hartog]") {
    const auto y = DenHartog(1.35, 0).motion(0.5, 0.5);
    REQUIRE(y);
    CHECK(std::fabs(y->fundamental_lag * 180 / pi - 140.69) <= 0.005);
    // cos lag = A/V, sin lag = -gamma U/V
    const double V = 1 / (1 - 1.35 * 1.35), U = std::tan(pi / 2.7) / 1.35;
    CHECK(std::cos(y->lag) == Approx(y->amplitude / V).epsilon(1e-14));
    CHECK(std::sin(y->lag) == Approx(-0.5 * U / V).epsilon(1e-14));
}

TEST_CASE("the stop boundary with Re = Rd and no viscous damping", "[den_hartog]") {
    // .3 to .45, where the velocity touches zero within the half cycle, from the same formulas in 40 digits.
    for (const Case& c : {Case{.6, 0, .531513}, Case{.7, 0, .722070}, Case{.8, 0, .817406}, Case{.85, 0, .826445},
                          Case{.9, 0, .819650}, Case{1.1, 0, .746772}, Case{1.35, 0, .674413}, Case{1.5, 0, .646579},
                          Case{2, 0, .596285}, Case{5, 0, .546033}, Case{.3, 0, .0864072779}, Case{.35, 0, .0383116014},
                          Case{.4, 0, .143890321}, Case{.45, 0, .24153451}}) {
        CAPTURE(c.r);
        CHECK(std::fabs(DenHartog(c.r, 0).stop_boundary(1) - c.value) <= (c.r < .5 ? 0.51e-9 : 1.01e-6));
    }
    CHECK(DenHartog(0.25, 0).stop_boundary(1) == Approx(1.0 / 15).epsilon(1e-15));
    CHECK(DenHartog(0.5, 0).stop_boundary(1) == Approx(1.0 / 3).epsilon(1e-15));
    CHECK(DenHartog(1, 0).stop_boundary(1) == Approx(pi / 4).epsilon(1e-15));
    CHECK(DenHartog(3, 0).stop_boundary(1) == Approx(9.0 / 16).epsilon(1e-15));
    CHECK(DenHartog(1e6, 0).stop_boundary(1) == Approx(1 / std::sqrt(1 + pi * pi / 4)).epsilon(1e-11));
    CHECK(DenHartog(0, 0).stop_boundary(1) == 0);
    // .85 is at the maximum.
    CHECK(DenHartog(.84, 0).stop_boundary(1) < .826445 + 1e-6);
    CHECK(DenHartog(.86, 0).stop_boundary(1) < .826445 + 1e-6);
}

TEST_CASE("the stop boundary with viscous damping, and with a greater breakaway", "[den_hartog]") {
    // .655530098 at r = .9 is what a bisection with the exact motion in long double gives, too.
    for (const Case& c : {Case{.7, .119, .543296}, Case{.9, .119, .655530}, Case{1, .119, .652596},
                          Case{1.35, .119, .604883}, Case{2, .119, .560392}}) {
        CHECK(std::fabs(DenHartog(c.r, c.zeta).stop_boundary(1) - c.value) <= 0.51e-6);
    }
    CHECK(std::fabs(DenHartog(.5, .119).stop_boundary(1) - .2429) <= 0.51e-4);
    for (const Case& c : {Case{.6, 0, .433656}, Case{.8, 0, .772750}, Case{1.25, 0, .686704}, Case{2, 0, .565332}}) {
        CHECK(std::fabs(DenHartog(c.r, c.zeta).stop_boundary(1.25) - c.value) <= 0.51e-6);
    }
}

TEST_CASE("the boundary keeps its digits near r = 1, r = 1/3, at strong damping and at great r", "[den_hartog]") {
    // Made from the hyperbolic form of the formulas in 40 digits.
    struct Digits {
        double r, zeta, factor, value;
    };
    for (const Digits& c : {Digits{1.000000000001, 1e-6, 1, .78539692969750285}, Digits{.999, 0, 1, .7857907331904124},
                            Digits{.33366666666666667, 1e-12, 1, .00078974588231697633},
                            Digits{58.163695490346385, .9820201304020605, 1.100129143950452, .51327243782320944},
                            Digits{.6406459605765799, 8.696782096767592, 1, .018361783518015042},
                            Digits{.9471809729931057, 1, 1, .21847962529520543}}) {
        CAPTURE(c.r, c.zeta);
        CHECK(DenHartog(c.r, c.zeta).stop_boundary(c.factor) == Approx(c.value).epsilon(2e-15));
    }
}

TEST_CASE("without stops there is a motion exactly up to the boundary", "[den_hartog]") {
    for (const double r : {.3, .45, .7, .999, 1.0, 1.3, 4.0}) {
        for (const double zeta : {0.0, 0.05, 0.999999, 1.0, 2.0}) {
            for (const double factor : {1.0, 1.3}) {
                const DenHartog theory(r, zeta);
                const double boundary = theory.stop_boundary(factor);
                CAPTURE(r, zeta, factor);
                // At resonance without damping Re does not matter: the amplitude grows past it.
                CHECK(theory.motion(boundary * (1 - 1e-9), factor * boundary * (1 - 1e-9)));
                CHECK_FALSE(theory.motion(boundary * (1 + 1e-9), factor * boundary * (1 + 1e-9)));
            }
        }
    }
}

TEST_CASE("without dry friction Den Hartog's motion is the harmonic one", "[den_hartog]") {
    for (const double r : {0.0, 0.5, 0.9, 1.0, 2.5}) {
        for (const double zeta : {0.0, 0.2, 1.5}) {
            if (r == 1 && zeta == 0) continue;
            const auto y = DenHartog(r, zeta).motion(0, 0);
            REQUIRE(y);
            CAPTURE(r, zeta);
            CHECK(y->amplitude == Approx(magnification(r, zeta)).epsilon(1e-14));
            CHECK(y->lag == Approx(phase_lag(r, zeta)).epsilon(1e-14));
            CHECK(y->fundamental_amplitude == Approx(y->amplitude).epsilon(1e-14));
        }
    }
}

TEST_CASE("at resonance without damping the motion grows below pi/4, and there is none above", "[den_hartog]") {
    const auto y = DenHartog(1, 0).motion(0.5, 0.7);
    REQUIRE(y);
    CHECK(y->amplitude == infinite);
    CHECK(y->lag == pi / 2);
    CHECK_FALSE(DenHartog(1, 0).motion(0.8, 0.8));
    // Next to it the amplitude is what the slope says: sqrt(1 - (4 gamma/pi)^2)/|1 - r^2|.
    const double r = 1 + 0x1p-30;
    CHECK(amplitude(r, 0.5) == Approx(std::sqrt(1 - 4 / (pi * pi)) / (2 * 0x1p-30)).epsilon(1e-8));
}

TEST_CASE("a run has stops beyond the boundary and none before it", "[den_hartog]") {
    struct Boundary {
        double r, zeta, factor;
    };
    for (const Boundary& c :
         {Boundary{.35, 0, 1}, Boundary{.42, 0, 1}, Boundary{.45, .05, 1}, Boundary{.7, 0, 1}, Boundary{.85, .119, 1},
          Boundary{1, .119, 1}, Boundary{1.35, 0, 1}, Boundary{2, 0, 1}, Boundary{.8, 0, 1.25},
          Boundary{1.25, .05, 1.25}, Boundary{.4, .02, 1.5}, Boundary{.6, 1.2, 1}}) {
        const DenHartog theory(c.r, c.zeta);
        const double boundary = theory.stop_boundary(c.factor);
        const auto start = theory.motion(0.998 * boundary, c.factor * 0.998 * boundary);
        REQUIRE(start);
        CAPTURE(c.r, c.zeta, c.factor, boundary);
        const auto with = [&](double gamma) {
            return from_the_peak(truth::nondimensional(c.zeta, gamma, c.factor * gamma), c.r, *start, 40);
        };
        CHECK(sticks_since(with(0.998 * boundary), 0) == 0);
        CHECK(sticks_since(with(1.01 * boundary), 30 / c.r) > 0);
    }
}

}  // namespace dinal::den_hartog_test
