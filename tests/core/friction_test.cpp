#include "model/sticking.hpp"

#include <cmath>
#include <limits>

#include "support/catch.hpp"

namespace dinal::friction_test {

using namespace dinal::model;

namespace {

Oscillator system_with(double k, double Rd, double Re) {
    return Oscillator::make({.inertia = 1, .stiffness = k, .kinetic_friction = Rd, .breakaway = Re}).value();
}
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("a mass at rest stays while |M - k theta| is at most Re, and leaves towards M - k theta", "[friction]") {
    const Oscillator system = system_with(2, 1, 1.5);
    CHECK(motion_from_standstill(system, 0, 0) == Motion::stuck);
    CHECK(motion_from_standstill(system, 1.4, 0) == Motion::stuck);
    CHECK(motion_from_standstill(system, 1.6, 0) == Motion::forward);
    CHECK(motion_from_standstill(system, -1.6, 0) == Motion::backward);
    CHECK(motion_from_standstill(system, 0, 0.8) == Motion::backward);
    CHECK(motion_from_standstill(system, 0, -0.8) == Motion::forward);
    CHECK(motion_from_standstill(system, 1.6, 0.8) == Motion::stuck);
    CHECK(motion_from_standstill(system, 3.2, 0.8) == Motion::forward);
}

TEST_CASE("breakaway is decided by Re, not by Rd", "[friction]") {
    const Oscillator system = system_with(2, 1, 1.5);
    CHECK(motion_from_standstill(system, 1.2, 0) == Motion::stuck);  // between Rd and Re
}

TEST_CASE("exactly at the limit the mass sticks; one unit in the last place of M more and it slips", "[friction]") {
    for (const double Re : {1.5, 0.167, 29.43, 1e-9, 1e9}) {
        const Oscillator system = system_with(4, 0, Re);
        CHECK(motion_from_standstill(system, Re, 0) == Motion::stuck);
        CHECK(motion_from_standstill(system, -Re, 0) == Motion::stuck);
        CHECK(motion_from_standstill(system, std::nextafter(Re, infinity), 0) == Motion::forward);
        CHECK(motion_from_standstill(system, -std::nextafter(Re, infinity), 0) == Motion::backward);
    }
    // With k theta on the same scale, all of it exact in binary: k theta = 1, Re = 0.5.
    const Oscillator system = system_with(4, 0, 0.5);
    CHECK(motion_from_standstill(system, 1.5, 0.25) == Motion::stuck);
    CHECK(motion_from_standstill(system, 0.5, 0.25) == Motion::stuck);
    CHECK(motion_from_standstill(system, std::nextafter(1.5, 2.0), 0.25) == Motion::forward);
    // Below k theta the doubles of M lie closer than k theta is known: the first that counts is 2^-53 k theta past.
    CHECK(motion_from_standstill(system, std::nextafter(0.5, 0.0), 0.25) == Motion::stuck);
    CHECK(motion_from_standstill(system, 0.5 - 0x1p-52, 0.25) == Motion::backward);
}

TEST_CASE("theta = Re/k is within the dead zone however the quotient was rounded", "[friction]") {
    int rounded_up = 0;
    for (int i = 1; i <= 20000; ++i) {
        const double Re = 0.1 + 0.37 * i / 20000.0;
        const double k = 3 + 1e-3 * i;
        const Oscillator system = system_with(k, Re, Re);
        const double theta = Re / k;
        rounded_up += std::fma(theta, k, -Re) > 0 ? 1 : 0;
        REQUIRE(motion_from_standstill(system, 0, theta) == Motion::stuck);
        REQUIRE(motion_from_standstill(system, 0, -theta) == Motion::stuck);
        // Two units further it is outside, beyond doubt: the grace is no tolerance.
        const double outside = std::nextafter(std::nextafter(theta, infinity), infinity);
        REQUIRE(motion_from_standstill(system, 0, outside) == Motion::backward);
        REQUIRE(motion_from_standstill(system, 0, -outside) == Motion::forward);
    }
    CHECK(rounded_up > 5000);  // the test means something: about half of the quotients are too great
}

TEST_CASE("the friction torque opposes the motion with Rd, and holds what there is to hold at rest", "[friction]") {
    const Oscillator system = system_with(2, 1, 1.5);
    CHECK(friction_torque(system, Motion::forward, 0.3, {0.1, 1}) == -1);
    CHECK(friction_torque(system, Motion::backward, 0.3, {0.1, 1}) == 1);
    CHECK(friction_torque(system, Motion::stuck, 0.75, {0.25, 0}) == -0.25);
    CHECK(friction_torque(system, Motion::stuck, 0.5, {0.25, 0}) == 0);
}

TEST_CASE("a torque that is no number moves nothing", "[friction]") {
    const Oscillator system = system_with(2, 1, 1.5);
    CHECK(motion_from_standstill(system, std::numeric_limits<double>::quiet_NaN(), 0) == Motion::stuck);
}

TEST_CASE("without dry friction any load moves the mass", "[friction]") {
    const Oscillator system = system_with(1, 0, 0);
    CHECK(motion_from_standstill(system, std::numeric_limits<double>::denorm_min(), 0) == Motion::forward);
    CHECK(motion_from_standstill(system, -1e-300, 0) == Motion::backward);
}

}  // namespace dinal::friction_test
