// Laws of friction with corners, named by the law: no bump between two of them is missed, however narrow.
// oracle_test.cpp has tables by lot.
#include <cmath>

#include "analysis/energy.hpp"
#include "model/drive.hpp"
#include "model/laws/tabulated.hpp"
#include "support/catch.hpp"
#include "support/kinds.hpp"
#include "support/mixed_truth.hpp"
#include "support/systems.hpp"
#include "support/within.hpp"

namespace dinal::corners_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using model::laws::Tabulated;

namespace {

Tabulated bump(double at, double width) {
    return {.speed = {0, at - width / 2, at, at + width / 2}, .torque = {0.3, 0.3, 0.6, 0.3}, .breakaway = 0.5};
}

/// An event's time may be off by its root for want of a slope.
void check(const Tabulated& law, const State& initial, double belt, double wall, double t_end) {
    constexpr double tolerance = 1e-10, restitution = 0.7;
    CAPTURE(law.lua_text(), belt, wall);
    model::Drive drive{harmonic(0.8, 0.3, 0.4), initial};
    drive.belts = {Excitation::make(Constant{belt}).value()};
    const Oscillator system = system_of(
        {.inertia = 1, .stiffness = 1, .damping = 0.02, .friction = law, .walls = Walls{-never, wall, restitution}});
    const auto run = simulate(system, drive, {0, t_end}, Grid::every(0.83), Spectral{});
    REQUIRE(run);

    MixedSystem same;
    same.C = 0.02L, same.sliding = lines_through(law.speed, law.torque);
    same.holding = {Friction(law).greatest_holding(), Friction(law).greatest_holding()};
    same.M = [](real t, const MixedPoint&) -> real { return 0.8L * std::sin(0.3L * t + 0.4L); };
    same.belt = [=](real) -> real { return belt; }, same.belt_rate = [](real) -> real { return 0; };
    same.walls = true, same.lower = -HUGE_VALL, same.upper = wall, same.restitution = restitution;
    const std::vector<double> times(run->column(Column::t).begin(), run->column(Column::t).end());
    const MixedTruth truth(same, {initial.theta, initial.velocity}, t_end, times);
    REQUIRE_FALSE(truth.doubtful);
    REQUIRE(truth.corners_passed + static_cast<int>(truth.events.size()) > 2);
    REQUIRE(run->events.size() == truth.events.size());
    for (std::size_t i = 0; i < run->events.size(); ++i) {
        CAPTURE(i, run->events[i].t);
        CHECK(name(as_stop(run->events[i].kind)) == truth.events[i].kind);
        CHECK(run->events[i].t == within(static_cast<double>(truth.events[i].t), 40 * tolerance));
        CHECK(run->events[i].theta == within(static_cast<double>(truth.events[i].theta), tolerance));
    }
    for (Eigen::Index i = 0; i < run->size(); ++i) {
        const MixedPoint& y = truth.motions[static_cast<std::size_t>(i)];
        CAPTURE(run->rows(i, 0));
        CHECK(run->rows(i, 1) == within(static_cast<double>(y.theta), tolerance));
        CHECK(run->rows(i, 2) == within(static_cast<double>(y.velocity), tolerance));
    }
    const auto energy = analysis::energy_of(*run);
    REQUIRE(energy);
    CHECK(energy->closure() < 1e-12);
    CHECK(energy->total.work.dry > 1e-3 * energy->flow);
}

}  // namespace

TEST_CASE(
    "friction tables that fall, rise, nearly jump or have a narrow bump move the mass as an independent integrator does",
    "[laws][corners][long]") {
    const Tabulated tables[] = {
        {.speed = {0, 0.5, 2}, .torque = {0.45, 0.2, 0.35}, .breakaway = 0.6},
        {.speed = {0, 0.05, 0.2, 0.6, 1}, .torque = {0.6, 0.4, 0.3, 0.32, 0.4}},
        {.speed = {0, 0.3}, .torque = {0.1, 0.7}},
        {.speed = {0, 0.3, 0.3 + 1e-6, 0.8, 0.8 + 1e-3}, .torque = {0.4, 0.4, 0.1, 0.1, 0.6}},
        {.speed = {0, 1e-4, 1}, .torque = {0.5, 0.3, 0.35}},
        {.speed = {0, 1e-3, 2e-3, 3e-3, 1}, .torque = {0.5, 0.2, 0.5, 0.2, 0.3}},
    };
    for (const Tabulated& table : tables) {
        check(table, {1.3, 0.2}, 0, 10, 14);
        check(table, {0.4, -0.3}, 0.25, 10, 14);
        check(table, {0.2, 1.5}, 0, 0.9, 14);
    }
    // A bump is passed in about the time width/theta'', and takes height width/(2 theta'') of the speed: 1e-6 and more.
    // (Later one holds the mass at its speed for long, where the truth takes steps without end.)
    for (const Tabulated& table : {bump(0.123, 1e-3), bump(0.4, 1e-3), bump(0.123, 1e-5)}) {
        check(table, {1.3, 0.2}, 0, 10, 12);
    }
}

TEST_CASE("a speed at or near a corner of a friction table does not end the run", "[laws][corners]") {
    // A block pushed to the very speed of a corner, where the push balances friction.
    const Tabulated table{.speed = {0, 1, 2}, .torque = {0.5, 0.3, 0.6}};
    const Oscillator block = Oscillator::make({.inertia = 1, .stiffness = 0, .friction = table}).value();
    const Excitation push = Excitation::make(Constant{0.3}).value();
    const Run run = must_run(block, push, {0, 1}, {0, 3}, Grid::every(0.5), Spectral{});
    CHECK(run.outcome == Outcome::reached_end);
    CHECK(run.state_at_stop.theta == within(3, 1e-12));
    // Above the corner friction rises: 0.3 v' = ... the speed comes back to it as exp(-0.3 t).
    const Run back = must_run(block, push, {0, 1.5}, {0, 20}, Grid::every(0.5), Spectral{});
    CHECK(back.state_at_stop.velocity == within(1 + 0.5 * std::exp(-6), 1e-12));
}

}  // namespace dinal::corners_test
