#include "model/oscillator.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/springs.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"

namespace dinal::oscillator_test {

using namespace dinal::model;

namespace {

using Catch::Matchers::Contains;

std::string complaint(const OscillatorParameters& parameters) {
    const auto system = Oscillator::make(parameters);
    return system ? "" : system.error().sentence;
}

}  // namespace

TEST_CASE("the regime is decided exactly, not within a tolerance", "[oscillator]") {
    const auto regime = [](double C) {
        return Oscillator::make({.inertia = 4, .stiffness = 9, .damping = C})->regime();
    };
    CHECK(regime(0) == Regime::undamped);
    CHECK(regime(std::nextafter(12.0, 0.0)) == Regime::underdamped);
    CHECK(regime(12) == Regime::critical);
    CHECK(regime(std::nextafter(12.0, 13.0)) == Regime::overdamped);
    CHECK(Oscillator::make({.inertia = 4, .stiffness = 9, .damping = 12})->damping_ratio() == 1);
    CHECK_FALSE(Oscillator::make({.inertia = 4, .stiffness = 9, .damping = 12})->damped_frequency());
    CHECK(name(Regime::undamped) == "undamped");
    CHECK(name(Regime::critical) == "critical");
    CHECK(name(Regime::overdamped) == "overdamped");
}

TEST_CASE("the report's system has the values that DINAL printed", "[oscillator]") {
    // I = 1, k = 39.48, c = 3: w0 = 6.283, T0 = 1.000, DZETA = 0.239
    const auto system = Oscillator::make({.inertia = 1, .stiffness = 39.48, .damping = 3, .kinetic_friction = 6.6});
    CHECK(system->natural_frequency() == Approx(6.283311).epsilon(1e-7));
    CHECK(system->natural_period() == Approx(0.99998).epsilon(1e-7));
    CHECK(system->damping_ratio() == Approx(0.2387276).epsilon(1e-6));
    // ZITA = Rd/|Mc| with Mc = k sqrt(theta0^2 + (v0/w0)^2)
    const double Mc = system->characteristic_torque({0, 6.2832});
    CHECK(Mc == Approx(39.4793).epsilon(1e-5));
    CHECK(system->friction_ratio(Mc) == Approx(0.167176).epsilon(1e-5));
    CHECK(system->friction_ratio(-Mc) == system->friction_ratio(Mc));
    CHECK(system->characteristic_torque({-2, 0}) == 2 * 39.48);
}

TEST_CASE("parameters with derived values that overflow are refused, other extreme ones are accepted", "[oscillator]") {
    CHECK_THAT(complaint({.inertia = 1e-300, .stiffness = 1e300}), Contains("too far apart"));
    CHECK_THAT(complaint({.inertia = 1e300, .stiffness = 1e-300}), Contains("too far apart"));
    const auto tiny = Oscillator::make({.inertia = 1e-200, .stiffness = 1e-200, .damping = 2e-200});
    REQUIRE(tiny);
    CHECK(tiny->natural_frequency() == Approx(1));
    CHECK(tiny->damping_ratio() == Approx(1));
}

TEST_CASE("numbers that only a program in C++ can give are refused, too", "[oscillator]") {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const std::pair<OscillatorParameters, const char*> systems[] = {
        {{.inertia = -1, .stiffness = 1}, "I = -1 must be positive"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Coulomb{inf, inf}}, "Rd = inf must be a finite number"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Coulomb{-1, 1}}, "Rd = -1 must not be negative"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::AsymmetricCoulomb{{-1, 1}, {1, 1}}}, "forward.Rd = -1"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Stribeck{.kinetic = 1, .breakaway = 2}}, "speed = 0 must"},
        {{.inertia = 1, .stiffness = 1, .spring = springs::PolynomialSpring{{{3, inf}}}}, "[3] = inf must be a finite"},
        {{.inertia = 1, .stiffness = 1, .walls = Walls{.lower = -1, .restitution = 2}},
         "restitution = 2 must be from 0 to 1"},
    };
    for (const auto& [parameters, sentence] : systems) CHECK_THAT(complaint(parameters), Contains(sentence));

    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const auto refused = [&](State start, motion::Window window, const motion::Grid& rows) {
        const auto run = motion::simulate(system, {{}, start}, window, rows, motion::Exact{});
        return run ? "" : run.error().sentence;
    };
    const auto none = motion::Grid::none();
    CHECK_THAT(refused({inf, 0}, {0, 1}, none), Contains("theta0 = inf must be a finite number"));
    CHECK_THAT(refused({0, inf}, {0, 1}, none), Contains("velocity0 = inf must be a finite number"));
    CHECK_THAT(refused({}, {-inf, 1}, none), Contains("t_start = -inf must be a finite number"));
    CHECK_THAT(refused({}, {0, inf}, none), Contains("t_end = inf must be a finite number"));
    CHECK_THAT(refused({}, {0, 1}, motion::Grid::every(0)), Contains("dt = 0 must be positive"));
    CHECK_THAT(refused({}, {0, 1}, motion::Grid::at({0, inf})), Contains("times[2] = inf must be a finite number"));
}

}  // namespace dinal::oscillator_test
