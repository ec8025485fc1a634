// Cases that lie exactly on an edge: the limit of sticking, a break at an event, the beginning and the end.
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "analysis/recurrence.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::razor_edge_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A test that asks for it runs once with each.
Integrator either(double h = 0.001) {
    return GENERATE_COPY(as<Integrator>{}, Exact{}, Spectral{}, Rk4{h});
}
/// What rk4 is allowed, or for the others a hundred roundings of numbers of order one.
double tolerance_of(const Integrator& integrator, double of_rk4) {
    return std::holds_alternative<Rk4>(integrator) ? of_rk4 : 2e-14;
}

/// I = 1/(4 pi^2), k = 1: T0 = 1.
Run run_of(const Oscillator& system, const Excitation& M, const State& initial, double t_end,
           const Integrator& integrator) {
    return must_run(system, M, initial, {0, t_end}, Grid::every(t_end / 64), integrator);
}

void check_never_moved(const Run& run, double theta) {
    CHECK(run.events.empty());
    CHECK((run.rows.col(1).array() == theta).all());
    CHECK((run.rows.col(2).array() == 0).all());
}

}  // namespace

TEST_CASE("a load of exactly Re holds for ever, one unit in the last place more does not", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    for (const double Re : {0.167, 0.836, 29.43, 1e-9, 3e7}) {
        const Oscillator system =
            system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.5 * Re, .breakaway = Re});
        for (const double side : {1.0, -1.0}) {
            CAPTURE(Re, side);
            const Run held = run_of(system, native(Constant{side * Re}), {0, 0}, 20, integrator);
            check_never_moved(held, 0);
            CHECK(held.outcome == Outcome::at_rest);
            const Run released =
                run_of(system, native(Constant{side * std::nextafter(Re, infinity)}), {0, 0}, 3, integrator);
            CHECK(side * released.rows(released.size() - 1, 1) > 0.5 * Re);
            CHECK(released.events.empty());  // nothing is an event at the start
        }
    }
}

TEST_CASE("theta0 = Re/k stays, for any k", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    for (int i = 1; i <= 2000; ++i) {
        const double Re = 0.1 + 0.9 * i / 2000;
        const double k = 1 + 0.0137 * i;
        const Oscillator system = system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Re});
        const Run run = run_of(system, {}, {i % 2 == 0 ? Re / k : -Re / k, 0}, 1, integrator);
        CAPTURE(Re, k);
        REQUIRE(run.events.empty());
        REQUIRE(run.outcome == Outcome::at_rest);
        REQUIRE(run.rows(run.size() - 1, 1) == run.rows(0, 1));
        // Two units further it is outside, beyond doubt: the grace is no tolerance.
        const Oscillator slippery =
            system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Re / 2, .breakaway = Re});
        const double outside = std::nextafter(std::nextafter(Re / k, infinity), infinity);
        REQUIRE(run_of(slippery, {}, {outside, 0}, 1, integrator).state_at_stop.theta < 0.9 * outside);
    }
}

TEST_CASE("a load that only touches the limit does not release", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    const Oscillator system = nondimensional(0, 0.25, 0.5);
    SECTION("a sine of amplitude Re, touching 40 times") {
        check_never_moved(run_of(system, harmonic(0.5, 2.3), {0, 0}, 50, integrator), 0);
        check_never_moved(run_of(system, harmonic(0.5, 2 * pi), {0, 0}, 20.25, integrator), 0);
    }
    SECTION("a parabola with its top at the limit") {
        // 1/2 - (t - 1)^2, and never more in doubles either.
        const Excitation parabola = native(Polynomial{.coefficients = {0.5, 0, -1}, .at = 1});
        check_never_moved(must_run(system, parabola, {0, 0}, {0.1, 1.9}, Grid::every(0.01), integrator), 0);
        check_never_moved(must_run(system, parabola, {0, 0}, {0.1003, 1.9}, Grid::every(0.01), either(0.0371)), 0);
    }
    SECTION("the corners of a triangle wave, which are breaks") {
        check_never_moved(run_of(system, native(Triangle{.amplitude = 0.5, .period = 1.7}), {0, 0}, 20, integrator), 0);
    }
    SECTION("a step up to the limit and back") {
        check_never_moved(run_of(system, native(Pulse{.amplitude = 0.5, .at = 1, .width = 0.3}), {0, 0}, 5, integrator),
                          0);
    }
}

TEST_CASE("a load that passes the limit between two samples releases", "[razor]") {
    const Oscillator system = nondimensional(0, 0.25, 0.5);
    // 1e-6 over the limit for a time of 2e-3, in steps of 0.01 that straddle it.
    const Excitation parabola = native(Polynomial{.coefficients = {0.5 + 1e-6, 0, -1}, .at = 1.0025});
    const Integrator integrator = either(0.01);
    const Run run = must_run(system, parabola, {0, 0}, {0.1, 1.9}, Grid::none(), integrator);
    REQUIRE_FALSE(run.events.empty());
    CHECK(run.events[0].kind == EventKind::slip);
    // A rounding of M moves the release by 1e-16 over its slope of 2e-3.
    CHECK(run.events[0].t == within(1.0015, tolerance_of(integrator, 1e-9) + 1e-13));
}

TEST_CASE("a release is at the time when M passes the limit, to rounding", "[razor]") {
    const Oscillator system = nondimensional(0.1, 0.25, 0.5);
    for (const Integrator& integrator :
         std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.01}, Rk4{0.0137}, Rk4{0.001}}) {
        const Run run =
            must_run(system, native(Ramp{.slope = 0.3, .at = 0.2}), {0, 0}, {0, 3}, Grid::none(), integrator);
        REQUIRE_FALSE(run.events.empty());
        CHECK(run.events[0].kind == EventKind::slip);
        CHECK(run.events[0].t == Approx(0.2 + 0.5 / 0.3).epsilon(4e-15));
        CHECK(run.events[0].theta == 0);
        CHECK(run.events[0].M == Approx(0.5).epsilon(4e-15));
    }
}

TEST_CASE("a mass at rest stays exactly where it is, for ever", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    const Oscillator system = nondimensional(0.01, 0.167);
    const Run run = must_run(system, harmonic(0.01, 3.3), {0, 2 * pi}, {0, 1000}, Grid::every(0.37), integrator);
    CHECK(run.outcome == Outcome::at_rest);
    const Event& last = run.events.back();
    CHECK(last.kind == EventKind::rest);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        if (run.rows(i, 0) < last.t) continue;
        REQUIRE(run.rows(i, 1) == last.theta);
        REQUIRE(run.rows(i, 2) == 0);
    }
    CHECK(run.at(777.77)->theta == last.theta);
    CHECK(run.at(777.77)->velocity == 0);
}

TEST_CASE("after a jump of M exactly at a turn the mass moves on under the new load", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    // Free with gamma = 0.2 from theta = 1: a turn at t = 0.5, theta = -0.6.
    const Oscillator system = nondimensional(0, 0.2);
    const double near = tolerance_of(integrator, 1e-9);
    for (const double ulps : {-1.0, 0.0, 1.0}) {
        const double at = 0.5 + ulps * 0x1p-53;
        CAPTURE(ulps);
        // To 0.5: on towards 0.3 +- 0.9, turn at t = 1, theta = 1.2.
        const Run onward = run_of(system, native(Step{.amplitude = 0.5, .at = at}), {1, 0}, 1.2, integrator);
        REQUIRE(onward.events.size() == 2);
        CHECK(onward.events[0].kind == EventKind::turn);
        CHECK(onward.events[0].theta == within(-0.6, near));
        CHECK(onward.events[1].kind == EventKind::turn);
        CHECK(onward.events[1].t == within(1, near));
        CHECK(onward.events[1].theta == within(1.2, near));
        // To -0.6, which balances the spring: at rest there, whichever comes first by rounding.
        const Run balanced = run_of(system, native(Step{.amplitude = -0.6, .at = at}), {1, 0}, 3, integrator);
        CHECK(balanced.outcome == Outcome::at_rest);
        REQUIRE_FALSE(balanced.events.empty());
        CHECK(balanced.events.size() <= 2);
        CHECK(balanced.events.back().kind == EventKind::rest);
        CHECK(balanced.events.back().t == within(0.5, near));
        CHECK(balanced.rows(balanced.size() - 1, 1) == within(-0.6, near));
    }
}

TEST_CASE("a jump of M on a stuck mass releases it at that very time", "[razor]") {
    const Oscillator system = nondimensional(0, 0.2, 0.3);
    for (const Integrator& integrator :
         std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.01}, Rk4{0.003}, Rk4{0.25}}) {
        for (const double at : {0.5, 0.503, 1.0 / 3}) {
            const Run run =
                must_run(system, native(Step{.amplitude = 0.5, .at = at}), {0.1, 0}, {0, 2}, Grid::none(), integrator);
            REQUIRE_FALSE(run.events.empty());
            CHECK(run.events[0].kind == EventKind::slip);
            CHECK(run.events[0].t == at);
            CHECK(run.events[0].theta == 0.1);
            CHECK(run.events[0].M == 0.5);
        }
    }
}

TEST_CASE("a break of M at t_start acts from the beginning", "[razor]") {
    const Oscillator system = nondimensional(0.1, 0.1);
    for (const Integrator& integrator :
         std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.001}, Dinal1989{.h = 0.001}}) {
        const Run step = run_of(system, native(Step{.amplitude = 0.7, .at = 0}), {0.2, 0.3}, 3, integrator);
        const Run level = run_of(system, native(Constant{0.7}), {0.2, 0.3}, 3, integrator);
        CHECK(step.rows == level.rows);
        CHECK(step.rows(0, 3) == 0.7);
    }
}

TEST_CASE("a break of M at t_end does not change the motion before it", "[razor]") {
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    const Oscillator system = nondimensional(0.1, 0.1);
    const Run without = run_of(system, {}, {1, 0.3}, 0.8, integrator);
    const Run with = run_of(system, native(Step{.amplitude = 5, .at = 0.8}), {1, 0.3}, 0.8, integrator);
    const Eigen::Index last = with.size() - 1;
    REQUIRE(with.rows(last, 0) == 0.8);
    CHECK(with.rows(last, 1) == Approx(without.rows(last, 1)).epsilon(1e-13));
    CHECK(with.rows(last, 2) == Approx(without.rows(last, 2)).epsilon(1e-13));
    CHECK(with.rows(last, 3) == 5);  // from the right, as everywhere
    CHECK(with.outcome == Outcome::reached_end);
}

TEST_CASE("breaks closer together than a step, and than rounding, are all obeyed", "[razor]") {
    const Integrator integrator = either(0.01);
    const Oscillator system = nondimensional(0, 0);
    // An impulse of 1e3 * 1e-4 at t = 0.5: velocity jumps by 0.1/I = 0.4 pi^2.
    const Run run = must_run(system, native(Pulse{.amplitude = 1e3, .at = 0.5, .width = 1e-4}), {0, 0}, {0, 0.75},
                             Grid::at({0.75}), integrator);
    // theta = 0.1/(I w0) sin w0 (t - 0.50005), but for the width: (w0 1e-4)^2/24.
    CHECK(run.rows(0, 1) == Approx(0.1 * 2 * pi * std::sin(2 * pi * (0.75 - 0.50005))).epsilon(1e-6));
    const Run spike = must_run(system, native(Pulse{.amplitude = 1e3, .at = 0.5, .width = 0x1p-53}), {0, 0}, {0, 0.75},
                               Grid::at({0.75}), integrator);
    CHECK(std::fabs(spike.rows(0, 1)) < 1e-11);
}

TEST_CASE("a function that returns nan ends the run, which keeps its rows", "[razor]") {
    class Breaking : public UserFunction {
    public:
        double value(double t, const State&) override { return t < 1 ? 0.5 : std::numeric_limits<double>::quiet_NaN(); }
    };
    for (const bool feedback : {false, true}) {
        for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.01}, Dinal1989{.h = 0.01}}) {
            const Excitation M = native(Scripted{.function = std::make_shared<Breaking>(), .feedback = feedback});
            const Run run = must_run(nondimensional(0.1, 0.1), M, {1, 0}, {0, 5}, Grid::every(0.1), integrator);
            CAPTURE(feedback, integrator.index());
            CHECK(run.outcome == Outcome::excitation_not_finite);
            CHECK(run.size() >= 9);
            CHECK(run.size() <= 11);
            CHECK(run.rows.matrix().allFinite());
            CHECK(run.t_stop <= 1.001);
            CHECK(run.t_stop >= 0.98);
        }
    }
}

TEST_CASE("a motion too large for its derivatives ends the run, also without friction", "[razor]") {
    // The fuzzer's: with a bound of the second derivative that is no number, the search for turns never ended.
    const double speed = GENERATE(-1e308, 1e305, 1e280);
    const double dry = GENERATE(0.0, 0.1);
    const Run run = run_of(nondimensional(0, dry), {}, {0, speed}, 2.5, either());
    CHECK((std::fabs(speed) > 1e300 || run.outcome == Outcome::reached_end));
    CHECK(run.rows.matrix().allFinite());
}

TEST_CASE("a decay whose last extreme is Re/k ends there", "[razor]") {
    // From Re/k + 2 n Rd/k: n half swings, each of which costs 2 Rd/k, end at Re/k.
    const Integrator integrator = GENERATE(as<Integrator>{}, Exact{}, Spectral{});
    for (const double k : {1.0, 4.0, 39.478417604357, 2.5}) {
        for (const double Rd : {0.5, 0.1, 0.25, 0.3}) {
            for (const double ratio : {1.0, 1.25, 1.5, 2.0, 3.0}) {
                for (int n = 1; n <= 6; ++n) {
                    const double Re = ratio * Rd;
                    const Oscillator system =
                        system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Rd, .breakaway = Re});
                    const Run run = must_run(system, {}, {(Re + 2 * n * Rd) / k, 0}, {0, 10 * system.natural_period()},
                                             Grid::none(), integrator);
                    CAPTURE(integrator.index(), k, Rd, ratio, n);
                    REQUIRE(run.events.size() == static_cast<std::size_t>(n));
                    const Event& last = run.events.back();
                    CHECK((last.kind == EventKind::rest || last.kind == EventKind::stick));
                    CHECK(std::fabs(last.t / system.natural_period() - 0.5 * n) <= 1e-12);
                    // It is held to the letter, and is there but for the roundings of its way.
                    const double held = std::fabs(k * run.state_at_stop.theta);
                    CHECK(held <= Re * (1 + 4e-16));
                    CHECK(held >= Re - 2e-14 * (Re + 2 * n * Rd));
                }
            }
        }
    }
}

TEST_CASE("a run knows whether it began stuck, whatever happened later", "[razor]") {
    const Oscillator system = nondimensional(0.05, 0.2, 0.3);
    const Integrator integrator = either();
    CAPTURE(integrator.index());
    const auto began_stuck = [&](const Excitation& M, const State& initial, const Oscillator& s) {
        const Run run = must_run(s, M, initial, {0, 3}, Grid::every(0.1), integrator);
        CHECK(analysis::stretches(run).front().stuck == run.began_stuck);
        return run.began_stuck;
    };
    CHECK(began_stuck({}, {0.1, 0}, system));
    CHECK(began_stuck(native(Step{.amplitude = 1, .at = 1}), {0, 0}, system));
    CHECK_FALSE(began_stuck({}, {1, 0}, system));
    CHECK_FALSE(began_stuck({}, {0, 1}, system));
    CHECK_FALSE(began_stuck({}, {0, 0}, nondimensional(0.05, 0)));
}

}  // namespace dinal::razor_edge_test
