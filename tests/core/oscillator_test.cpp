#include "model/oscillator.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "support/catch.hpp"

namespace dinal::oscillator_test {

using namespace dinal::model;

namespace {

using Catch::Matchers::Contains;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

std::string complaint(const OscillatorParameters& parameters) {
    const auto system = Oscillator::make(parameters);
    return system ? "" : system.error().sentence;
}

}  // namespace

TEST_CASE("the derived values of the contract's system", "[oscillator]") {
    const double k = 4 * 3.141592653589793 * 3.141592653589793;
    const auto system =
        Oscillator::make({.inertia = 1, .stiffness = k, .damping = 1.5, .kinetic_friction = 16.5, .breakaway = 18});
    REQUIRE(system);
    CHECK(system->natural_frequency() == Approx(6.283185307).epsilon(1e-9));
    CHECK(system->natural_period() == Approx(1).epsilon(1e-15));
    CHECK(system->damping_ratio() == Approx(0.1193662).epsilon(1e-6));
    CHECK(system->regime() == Regime::underdamped);
    CHECK(name(system->regime()) == "underdamped");
    CHECK(system->dead_zone() == Approx(0.455945).epsilon(1e-6));
    CHECK(*system->damped_frequency() == Approx(system->natural_frequency() * 0.99285).epsilon(1e-5));
    CHECK_FALSE(system->friction().none());
}

TEST_CASE("C and Rd default to 0 and Re to Rd", "[oscillator]") {
    const auto plain = Oscillator::make({.inertia = 2, .stiffness = 8});
    REQUIRE(plain);
    CHECK(plain->damping() == 0);
    CHECK(plain->kinetic_friction() == 0);
    CHECK(plain->breakaway() == 0);
    CHECK(plain->friction().none());
    const auto dry = Oscillator::make({.inertia = 2, .stiffness = 8, .kinetic_friction = 3});
    REQUIRE(dry);
    CHECK(dry->breakaway() == 3);
    // Sticking without kinetic friction is unusual and allowed.
    const auto sticky = Oscillator::make({.inertia = 2, .stiffness = 8, .breakaway = 3});
    REQUIRE(sticky);
    CHECK_FALSE(sticky->friction().none());
}

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

TEST_CASE("wrong parameters are named with their value and their range", "[oscillator]") {
    CHECK_THAT(complaint({.inertia = 0, .stiffness = 1}), Contains("I = 0") && Contains("positive"));
    CHECK_THAT(complaint({.inertia = -2, .stiffness = 1}), Contains("I = -2") && Contains("positive"));
    CHECK_THAT(complaint({.inertia = 1, .stiffness = -1}), Contains("k = -1") && Contains("negative"));
    CHECK(complaint({.inertia = 1, .stiffness = 0}).empty());  // a block without a spring
    CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .damping = -0.1}), Contains("C = -0.1"));
    CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .kinetic_friction = -1}), Contains("Rd = -1"));
    CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .breakaway = -1}), Contains("Re = -1"));
    CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .kinetic_friction = 2, .breakaway = 1}),
               Contains("Re = 1") && Contains("Rd = 2"));
    for (const double bad : {not_a_number, infinity, -infinity}) {
        CHECK_THAT(complaint({.inertia = bad, .stiffness = 1}), Contains("I = ") && Contains("finite"));
        CHECK_THAT(complaint({.inertia = 1, .stiffness = bad}), Contains("k = ") && Contains("finite"));
        CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .damping = bad}), Contains("C = ") && Contains("finite"));
        CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .kinetic_friction = bad}), Contains("Rd = "));
        CHECK_THAT(complaint({.inertia = 1, .stiffness = 1, .breakaway = bad}), Contains("Re = "));
    }
}

TEST_CASE("parameters whose derived values leave the doubles are refused, extreme ones that do not are taken",
          "[oscillator]") {
    CHECK_THAT(complaint({.inertia = 1e-300, .stiffness = 1e300}), Contains("too far apart"));
    CHECK_THAT(complaint({.inertia = 1e300, .stiffness = 1e-300}), Contains("too far apart"));
    const auto tiny = Oscillator::make({.inertia = 1e-200, .stiffness = 1e-200, .damping = 2e-200});
    REQUIRE(tiny);
    CHECK(tiny->natural_frequency() == Approx(1));
    CHECK(tiny->damping_ratio() == Approx(1));
}

}  // namespace dinal::oscillator_test
