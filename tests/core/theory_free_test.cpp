// Closed forms of free motion against the report's numbers, an independent exact solution, and rk4.
#include "theory/theory_free.hpp"

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
#include "support/within.hpp"

namespace dinal::theory_free_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::theory;
using truth::nondimensional;

namespace {

constexpr double pi = std::numbers::pi;

/// Half a unit of the ninth decimal, the last one printed.
constexpr double printed = 0.51e-9;

truth::ExactMotion true_motion(const Oscillator& system, const State& initial, double end) {
    return {system, {truth::Piece{}}, initial, 0, end};
}

void check_extremes(const FreeMotion& motion, const std::vector<Extreme>& expected) {
    REQUIRE(motion.extremes() == static_cast<double>(expected.size()));
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Extreme found = motion.extreme(static_cast<double>(i));
        CHECK(std::fabs(found.t - expected[i].t) <= printed);
        CHECK(std::fabs(found.theta - expected[i].theta) <= printed);
    }
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

TEST_CASE("figure 22: the half-cycle map gives the extremes and the rest of dry friction", "[theory]") {
    const FreeMotion motion(nondimensional(0, 0.167), {0, 2 * pi});
    check_extremes(motion, {{0.223664157, 0.846848608},
                            {0.723664157, -0.512848608},
                            {1.223664157, 0.178848608},
                            {1.723664157, 0.155151392}});
    CHECK(std::fabs(motion.time_to_rest() - 1.723664157) <= printed);
    CHECK(std::fabs(*motion.rest_position() - 0.155151392) <= printed);
}

TEST_CASE("figure 26: the half-cycle map with both frictions", "[theory]") {
    const FreeMotion motion(nondimensional(0.119, 0.06), {0, 2 * pi});
    REQUIRE(motion.extremes() == 4);
    const double theta[] = {0.793829171, -0.443584361, 0.203231680, -0.038291587};
    for (int i = 0; i < 4; ++i) CHECK(std::fabs(motion.extreme(i).theta - theta[i]) <= printed);
    CHECK(std::fabs(motion.time_to_rest() - 1.733933195) <= printed);
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
        const double start = initial.velocity == 0 ? 1 : 0;  // which is not an event
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

TEST_CASE("the duration of a free motion is (1 - A)/(4 gamma) with A, the last angle, within gamma", "[theory]") {
    for (const double gamma : {0.3, 0.167, 0.1, 0.03, 0.01, 1e-3, 1e-5}) {
        const FreeMotion motion(nondimensional(0, gamma), {1, 0});
        const double t = motion.time_to_rest();
        // A counts as negative when the mass stops on the side it came from: gamma = 0.3 stops at -0.2, not at 0.2.
        const double A = 1 - 4 * gamma * t;
        CAPTURE(gamma);
        CHECK(std::fabs(A) <= gamma + 1e-12);
        CHECK(std::fabs(A) == within(std::fabs(*motion.rest_position()), 1e-12));
        CHECK(t == std::ceil((1 - gamma) / (2 * gamma)) / 2);
    }
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
    CHECK(motion.at(1e12).theta == Approx(1 - 0.4).epsilon(1e-3));  // an eighth of 1e-3 period is left of t's digits
}

TEST_CASE("almost no damping takes as many half cycles as none", "[theory]") {
    for (const double zeta : {0.0, 1e-305, 1e-300}) {
        CAPTURE(zeta);
        CHECK(HalfCycles(zeta, 1e12).until_within(1e12, 1e300) / 5e287 == Approx(1).epsilon(1e-11));
        CHECK(HalfCycles(zeta, 0.1).until_within(0.1, 1) == 5);
        CHECK(HalfCycles(zeta, 1e290).until_within(1e290, 1e294) == Approx(4999.5).epsilon(2e-4));
    }
}

TEST_CASE("the closed form of a decay whose last extreme is Re/k ends there", "[theory]") {
    for (const double k : {1.0, 4.0, 39.478417604357, 2.5}) {
        for (const double Rd : {0.5, 0.1, 0.25, 0.3}) {
            for (const double ratio : {1.0, 1.25, 1.5, 2.0, 3.0}) {
                for (int n = 1; n <= 6; ++n) {
                    const double Re = ratio * Rd;
                    const FreeMotion motion(
                        truth::system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Rd, .breakaway = Re}),
                        {(Re + 2 * n * Rd) / k, 0});
                    CAPTURE(k, Rd, ratio, n);
                    CHECK(motion.extremes() == n + 1);
                }
            }
        }
    }
}

TEST_CASE("inside the dead zone no motion begins", "[theory]") {
    const FreeMotion motion(nondimensional(0.1, 0.1, 0.2), {0.2, 0});
    CHECK(motion.time_to_rest() == 0);
    CHECK(motion.rest_position() == 0.2);
    CHECK(motion.extremes() == 1);
    CHECK(motion.at(7).theta == 0.2);
}

TEST_CASE("an overdamped mass creeps to the edge Rd/k for ever", "[theory]") {
    const FreeMotion motion(nondimensional(1.5, 0.1), {1, 0});
    CHECK(motion.time_to_rest() == never);
    CHECK(motion.rest_position() == 0.1);
    CHECK(motion.at(30).theta == within(0.1, 1e-15));
    CHECK(motion.extremes() == 1);

    // Thrown at the middle from afar it never turns; thrown past it, it turns once and stays.
    CHECK(FreeMotion(nondimensional(1.5, 0.1), {1, -1}).extremes() == 0);
    CHECK(FreeMotion(nondimensional(1.5, 0.1), {1, -1}).rest_position() == 0.1);
    CHECK(FreeMotion(nondimensional(1.5, 0.1), {0, 0.5}).time_to_rest() < 1);
}

TEST_CASE("without dry friction a motion swings for ever, or tends to the middle", "[theory]") {
    const FreeMotion undamped(nondimensional(0, 0), {1, 0});
    CHECK(undamped.time_to_rest() == never);
    CHECK_FALSE(undamped.rest_position());
    CHECK(undamped.extremes() == never);
    CHECK(undamped.extreme(3).theta == -1);
    CHECK(FreeMotion(nondimensional(0.1, 0), {1, 0}).rest_position() == 0.0);
    CHECK(FreeMotion(nondimensional(1, 0), {1, 0}).rest_position() == 0.0);
    // Breakaway alone, without kinetic friction, stops a damped swing.
    CHECK(FreeMotion(nondimensional(0.1, 0, 0.1), {1, 0}).time_to_rest() < 5);
    CHECK(FreeMotion(nondimensional(0, 0, 0.1), {1, 0}).time_to_rest() == never);
}

TEST_CASE("three extremes determine both dampings", "[theory]") {
    truth::Lot chance(4);
    for (int i = 0; i < 100; ++i) {
        const double zeta = i % 10 == 0 ? 0 : chance.between(0, 0.3);
        const double shift = i % 10 == 1 ? 0 : chance.between(0, 0.02);
        const HalfCycles map(zeta, shift);
        const auto found = identify(1, map.after(1, 1), map.after(2, 1));
        CAPTURE(zeta, shift);
        REQUIRE(found);
        // The extremes carry roundings of 1e-16, which weigh more the smaller their differences are.
        const double lost = 4e-16 / (1 - std::fabs(map.after(1, 1)));
        CHECK(std::fabs(found->zeta - zeta) <= lost);
        CHECK(std::fabs(found->friction_shift - shift) <= lost);
    }
    CHECK_FALSE(identify(1, 1, 0.5));
    CHECK_FALSE(identify(1, 0.5, 0.6));
    CHECK(identify(1, 0.8, 0.5)->zeta < 0);  // falls faster and faster: not these dampings, and said so
}

TEST_CASE("the decrement of viscous friction", "[theory]") {
    CHECK(logarithmic_decrement(0.119) == Approx(2 * pi * 0.119 / std::sqrt(1 - 0.119 * 0.119)).epsilon(1e-15));
}

}  // namespace dinal::theory_free_test
