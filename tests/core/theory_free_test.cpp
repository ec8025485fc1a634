// Closed forms of free motion against runs; printed numbers are in tests/lua/theory_test.lua.
#include "theory/theory_free.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/random_case.hpp"
#include "support/systems.hpp"
#include "support/within.hpp"

namespace dinal::theory_free_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::theory;
using truth::nondimensional;

TEST_CASE("free motion is that of a run in all regimes and between them, event by event and in between", "[theory]") {
    truth::Lot chance(2);
    int rests = 0;
    for (int i = 0; i < 300; ++i) {
        const double near_one = 1 + (i % 2 == 0 ? 1 : -1) * chance.power_of_ten(-16, -1);
        const double zeta = i % 4 == 0   ? 0
                            : i % 4 == 1 ? chance.between(0, 0.3)
                            : i % 4 == 2 ? near_one
                                         : chance.power_of_ten(-6, 1.5);
        const double gamma = i % 5 == 0 ? 0 : chance.between(0.005, 0.3);
        const Oscillator system = nondimensional(zeta, gamma, gamma * (i % 2 == 0 ? 1 : chance.between(1, 2)));
        const State initial{chance.between(-1, 1), i % 7 == 0 ? 0 : chance.between(-6, 6)};
        const double end = 12;
        // Not by exact, which has closed forms, too.
        const Run run = truth::must_run(system, {}, initial, {0, end}, Grid::none(), Spectral{1e-14});
        const FreeMotion motion(system, initial);
        CAPTURE(zeta, gamma, initial.theta, initial.velocity);
        for (int j = 0; j < 20; ++j) {
            const double t = chance.between(0, end);
            REQUIRE(motion.at(t).theta == within(run.at(t)->theta, 1e-13));
            REQUIRE(motion.at(t).velocity == within(run.at(t)->velocity, 1e-12));
        }
        // Rows at even times, and at times that are almost even.
        std::vector<double> times, theta(40);
        for (int j = 0; j < 40; ++j) times.push_back(5 + 0.3 * j + (i % 2 == 0 ? 0 : chance.between(0, 1e-10)));
        free_decay(system, initial, times, {}, theta);
        for (std::size_t j = 0; j < times.size(); ++j) {
            REQUIRE(theta[j] == within(run.at(times[j] - times[0])->theta, 1e-13));
        }
        if (zeta >= 1) continue;  // a run also calls a mass stuck that creeps closer than rounding
        REQUIRE((run.outcome == Outcome::at_rest) == (motion.time_to_rest() < end));
        if (run.outcome != Outcome::at_rest || run.events.empty()) continue;
        ++rests;
        const double start =
            initial.velocity == 0 ? 1 : 0;  // a start at rest counts as an extreme, but is not an event
        REQUIRE(motion.extremes() == static_cast<double>(run.events.size()) + start);
        REQUIRE(motion.time_to_rest() == within(run.events.back().t, 1e-12));
    }
    CHECK(rests > 100);
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
