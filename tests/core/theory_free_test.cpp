// Closed forms of free motion against an independent exact solution; printed numbers are in tests/lua/theory_test.lua.
#include "theory/theory_free.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"

namespace dinal::theory_free_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::theory;
using truth::nondimensional;

namespace {

truth::ExactMotion true_motion(const Oscillator& system, const State& initial, double end) {
    return {system, {truth::Piece{}}, initial, 0, end};
}

}  // namespace

TEST_CASE("the free response is exact in all regimes and between them", "[theory]") {
    truth::Lot chance(1);
    for (int i = 0; i < 400; ++i) {
        const double near_one = 1 + (i % 2 == 0 ? 1 : -1) * chance.power_of_ten(-16, -1);
        const double zeta = i % 4 == 0 ? near_one : i % 4 == 1 ? chance.power_of_ten(-6, 2) : chance.between(0, 2);
        const Oscillator system = nondimensional(zeta, 0);
        const State initial{chance.between(-1, 1), chance.between(-6, 6)};
        const double t = chance.between(0, 3);
        const truth::Motion y = true_motion(system, initial, 3).at(t);
        const State found = free_response(system.natural_frequency(), system.damping_ratio(), initial, t);
        CAPTURE(zeta, t);
        // A hundred roundings of the size of the motion; the velocity is greater by w0.
        REQUIRE(std::fabs(found.theta - static_cast<double>(y.theta)) <= 1e-14);
        REQUIRE(std::fabs(found.velocity - static_cast<double>(y.velocity)) <= 1e-13);
    }
}

TEST_CASE("free motion with dry friction is exact, event by event and in between", "[theory]") {
    truth::Lot chance(2);
    int rests = 0;
    for (int i = 0; i < 300; ++i) {
        const double zeta = i % 3 == 0 ? 0 : chance.between(0, i % 3 == 1 ? 0.3 : 1.6);
        const double gamma = chance.between(0.005, 0.3);
        const Oscillator system = nondimensional(zeta, gamma, gamma * (i % 2 == 0 ? 1 : chance.between(1, 2)));
        const State initial{chance.between(-1, 1), i % 5 == 0 ? 0 : chance.between(-6, 6)};
        const double end = 12;
        const truth::ExactMotion y = true_motion(system, initial, end);
        const FreeMotion motion(system, initial);
        CAPTURE(zeta, gamma, initial.theta, initial.velocity);
        for (int j = 0; j < 20; ++j) {
            const double t = chance.between(0, end);
            // A few roundings for each half cycle, and t itself is rounded.
            REQUIRE(std::fabs(motion.at(t).theta - static_cast<double>(y.at(t).theta)) <= 2e-14);
            REQUIRE(std::fabs(motion.at(t).velocity - static_cast<double>(y.at(t).velocity)) <= 2e-13);
        }
        // Rows at even times, and at times that are almost even.
        std::vector<double> times, theta(40);
        for (int j = 0; j < 40; ++j) times.push_back(5 + 0.3 * j + (i % 2 == 0 ? 0 : chance.between(0, 1e-10)));
        free_decay(system, initial, times, {}, theta);
        for (std::size_t j = 0; j < times.size(); ++j) {
            REQUIRE(std::fabs(theta[j] - static_cast<double>(y.at(times[j] - times[0]).theta)) <= 2e-14);
        }
        const double start =
            initial.velocity == 0 ? 1 : 0;  // a start at rest counts as an extreme, but is not an event
        if (motion.time_to_rest() < end && !y.events().empty()) {
            ++rests;
            REQUIRE(motion.extremes() == static_cast<double>(y.events().size()) + start);
            REQUIRE(y.ends_stuck());
            REQUIRE(std::fabs(motion.time_to_rest() - static_cast<double>(y.events().back().t)) <= 2e-14);
        }
        REQUIRE(y.ends_stuck() == (motion.time_to_rest() < end));
    }
    CHECK(rests > 150);
}

TEST_CASE("n half cycles at once equal n single ones", "[theory]") {
    for (const double zeta : {0.0, 1e-12, 1e-4, 0.05}) {
        const HalfCycles map(zeta, 0.003);
        double X = 1;
        for (int n = 1; n <= 60 && std::fabs(X) > 0.003; ++n) {
            X = map.after(1, X);
            // Sixty roundings; small zeta must not cost more.
            REQUIRE(std::fabs(map.after(n, 1) - X) <= 60 * 2.3e-16);
        }
    }
}

TEST_CASE("a motion of 2.5e12 cycles is computed as quickly and exactly as a short one", "[theory]") {
    const double gamma = 1e-13;
    const FreeMotion motion(nondimensional(0, gamma), {1, 0});
    CHECK(motion.time_to_rest() == Approx(0.25 / gamma).epsilon(1e-12));
    CHECK(std::fabs(*motion.rest_position()) <= gamma);
    CHECK(motion.at(1e12).theta ==
          Approx(1 - 0.4).epsilon(1e-3));  // t = 1e12 has a resolution of an eighth of 1e-3 period
}

TEST_CASE("almost no damping takes as many half cycles as none", "[theory]") {
    for (const double zeta : {0.0, 1e-305, 1e-300}) {
        CAPTURE(zeta);
        CHECK(HalfCycles(zeta, 1e12).until_within(1e12, 1e300) / 5e287 == Approx(1).epsilon(1e-11));
        CHECK(HalfCycles(zeta, 0.1).until_within(0.1, 1) == 5);
        CHECK(HalfCycles(zeta, 1e290).until_within(1e290, 1e294) == Approx(4999.5).epsilon(2e-4));
    }
}

}  // namespace dinal::theory_free_test
