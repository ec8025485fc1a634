// Step limits: the printed one, its argument carried through, and the true one of rk4.
#include "theory/theory_free.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "motion/rk4/rk4.hpp"
#include "support/catch.hpp"
#include "support/reference_systems.hpp"

namespace dinal::theory_steps_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::theory;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("deltatmax is the value that the listing prints", "[theory]") {
    // Figure 22 as it was typed: deltatmax = T0 0.167/6.283311 = 0.0266 (examples/classic.lua shows it).
    const Oscillator system = truth::system_of({.inertia = 1, .stiffness = 39.48, .kinetic_friction = 6.59316});
    const State initial{0, 6.283311};
    const double limit = printed_step_limit(system, initial, 39.48);
    CHECK(limit == Approx(system.natural_period() * 0.167 / 6.283311).epsilon(1e-9));
    CHECK(std::fabs(limit - 0.0266) <= 0.00005);
}

TEST_CASE("the corrected limit is zeta/pi + gamma K in any units", "[theory]") {
    const double zeta = 0.119, gamma = 0.06;
    // Free motion of unit energy: u' is at most 2 pi, so K = 1/(2 pi).
    CHECK(euler_step_limit(truth::nondimensional(zeta, gamma), {0, 2 * pi}) ==
          Approx(zeta / pi + gamma / (2 * pi)).epsilon(1e-14));
    // The same system: T0 = 10 time units, and angles 7 times as great.
    const double I = 3, T0 = 10, angle = 7;
    const double w0 = 2 * pi / T0, k = I * w0 * w0;
    const Oscillator system = truth::system_of(
        {.inertia = I, .stiffness = k, .damping = 2 * zeta * I * w0, .kinetic_friction = gamma * k * angle});
    CHECK(euler_step_limit(system, {0, angle * w0}) == Approx(T0 * (zeta / pi + gamma / (2 * pi))).epsilon(1e-14));
}

TEST_CASE("neither step limit of the report is that of rk4", "[theory]") {
    const Oscillator system = truth::nondimensional(0.02387, 0);
    CHECK(printed_step_limit(system, {1, 0}, 1) == Approx(0.02387).epsilon(1e-14));
    CHECK(euler_step_limit(system, {1, 0}) == Approx(0.02387 / pi).epsilon(1e-14));
    CHECK(std::fabs(rk4::stability_limit(system) - 0.457) <= 0.0005);
    CHECK(std::fabs(rk4::stability_limit(truth::nondimensional(0, 0)) - 0.4502) <= 0.00005);
}

TEST_CASE("step limits without friction or without motion", "[theory]") {
    CHECK(euler_step_limit(truth::nondimensional(0, 0), {0, 0}) == 0);
    CHECK(printed_step_limit(truth::nondimensional(0, 0), {0, 0}, 0) == 0);
    CHECK(euler_step_limit(truth::nondimensional(0, 0.1), {0, 0}) == std::numeric_limits<double>::infinity());
}

}  // namespace dinal::theory_steps_test
