// Laws of friction with corners, named by the law: no bump between two of them is missed, however narrow.
#include <cmath>
#include <random>

#include "analysis/energy.hpp"
#include "model/extras.hpp"
#include "model/laws/stribeck.hpp"
#include "model/laws/tabulated.hpp"
#include "support/catch.hpp"
#include "support/corner_truth.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::corners_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using model::laws::Stribeck;
using model::laws::Tabulated;

namespace {

/// One case for dinal and for the truth. All is about 1.
struct Case {
    Friction law;
    std::vector<CornerRange> ranges;
    double C = 0.02, k = 1;
    State initial{1.3, 0.2};
    double amplitude = 0.8, omega = 0.3, phase = 0.4;
    double belt = 0;
    std::optional<Walls> walls = {};
    double t_end = 25;
};

Case with_table(const Tabulated& law) {
    return {.law = law, .ranges = lines_through(law.speed, law.torque)};
}

CornerTruth truth_of(const Case& c, const std::vector<double>& times) {
    CornerSystem s{
        .C = c.C,
        .k = c.k,
        .Re = c.law.greatest_holding(),
        .law = c.ranges,
        .M = [&c](real t) -> real { return c.amplitude * std::sin(c.omega * t + static_cast<real>(c.phase)); },
        .belt = c.belt,
        .quickest = std::max(1.0, c.omega)};
    if (c.walls) s.wall = c.walls->upper, s.restitution = c.walls->restitution;
    return {s, {c.initial.theta, c.initial.velocity}, c.t_end, times};
}

Trajectory run_of(const Case& c, bool with_more) {
    const auto system =
        Oscillator::make({.inertia = 1, .stiffness = c.k, .damping = c.C, .friction = c.law, .walls = c.walls});
    REQUIRE(system);
    static const Excitation none;
    Extras extras;
    if (c.belt != 0) extras.belt = Excitation::make(Constant{c.belt}).value();
    if (with_more) {
        extras.states.push_back(
            {"z", 0, written([](double, const State& y, std::span<const double>) { return y.velocity; })});
    }
    const Excitation M = harmonic(c.amplitude, c.omega, c.phase);
    auto run = simulate(*system, M, c.initial, {0, c.t_end}, Grid::every(0.83), Spectral{}, {}, {}, extras);
    if (!run) FAIL(run.error().sentence);
    return std::move(run).value();
}

/// An event's time may be off by its root for want of a slope.
void check(const Case& c, double tolerance) {
    for (const bool with_more : {false, true}) {
        CAPTURE(with_more, c.belt);
        const Trajectory run = run_of(c, with_more);
        const std::vector<double> times(run.column(Column::t).begin(), run.column(Column::t).end());
        const CornerTruth truth = truth_of(c, times);
        std::string found, expected;
        for (const Event& event : run.events) {
            found += std::string(event.kind == EventKind::rest ? "stick" : name(event.kind)) + " ";
        }
        for (const auto& event : truth.events) expected += event.kind + " ";
        REQUIRE(found == expected);
        REQUIRE(truth.corners_passed > 2);
        for (std::size_t i = 0; i < run.events.size(); ++i) {
            CAPTURE(i, run.events[i].t);
            CHECK(run.events[i].t == within(static_cast<double>(truth.events[i].t), 40 * tolerance));
            CHECK(run.events[i].theta == within(static_cast<double>(truth.events[i].theta), tolerance));
        }
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const auto& y = truth.motions[static_cast<std::size_t>(i)];
            CAPTURE(i, run.rows(i, 0));
            CHECK(run.rows(i, 1) == within(static_cast<double>(y.theta), tolerance));
            CHECK(run.rows(i, 2) == within(static_cast<double>(y.velocity), tolerance));
        }
        const auto energy = analysis::energy_of(run);
        REQUIRE(energy);
        CHECK(energy->closure() < 1e-11);  // states make of it some digits less than 1e-12
        CHECK(energy->total.work.dry > 1e-3 * energy->flow);
    }
}

Tabulated bump(double at, double width, double height) {
    return {
        .speed = {0, at - width / 2, at, at + width / 2}, .torque = {0.3, 0.3, 0.3 + height, 0.3}, .breakaway = 0.5};
}

}  // namespace

TEST_CASE("a bump of a table is felt however narrow it is, and at whatever speed", "[laws][corners][long]") {
    // It is passed in about the time width/theta'', and takes height width/(2 theta'') of the speed: 1e-6 and more.
    // (Where it holds the mass at its speed for long, the truth takes steps without end.)
    for (const auto& [at, width] : {std::pair{0.123, 1e-3}, {0.4, 1e-3}, {0.123, 1e-5}}) {
        CAPTURE(width, at);
        Case c = with_table(bump(at, width, 0.3));
        c.t_end = 12;
        check(c, 1e-10);
    }
}

TEST_CASE("tables that fall, rise and nearly jump move as an independent integrator says", "[laws][corners][long]") {
    const Tabulated tables[] = {
        {.speed = {0, 0.5, 2}, .torque = {0.45, 0.2, 0.35}, .breakaway = 0.6},
        {.speed = {0, 0.05, 0.2, 0.6, 1}, .torque = {0.6, 0.4, 0.3, 0.32, 0.4}},
        {.speed = {0, 0.3}, .torque = {0.1, 0.7}},
        {.speed = {0, 0.3, 0.3 + 1e-6, 0.8, 0.8 + 1e-3}, .torque = {0.4, 0.4, 0.1, 0.1, 0.6}},
        {.speed = {0, 1e-4, 1}, .torque = {0.5, 0.3, 0.35}},
        {.speed = {0, 1e-3, 2e-3, 3e-3, 1}, .torque = {0.5, 0.2, 0.5, 0.2, 0.3}},
    };
    for (const Tabulated& table : tables) {
        CAPTURE(table.lua_text());
        check(with_table(table), 1e-10);
        Case on_belt = with_table(table);
        on_belt.belt = 0.25, on_belt.initial = {0.4, -0.3};
        check(on_belt, 1e-10);
        Case at_wall = with_table(table);
        at_wall.walls = Walls{-10, 0.9, 0.7}, at_wall.initial = {0.2, 1.5};
        check(at_wall, 1e-10);
    }
}

TEST_CASE("random tables move as an independent integrator says", "[laws][corners][long]") {
    std::mt19937_64 random(20261123);
    const auto between = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    for (int i = 0; i < 20; ++i) {
        Tabulated table{.speed = {0}, .torque = {between(0.05, 0.5)}};
        const int corners = 1 + i % 6;
        for (int j = 0; j < corners; ++j) {
            table.speed.push_back(table.speed.back() + std::pow(10, between(-3, 0)));
            table.torque.push_back(between(0, 0.6));
        }
        table.breakaway = table.torque[0] * between(1, 1.5);
        Case c = with_table(table);
        c.amplitude = between(0.5, 2), c.omega = between(0.2, 2), c.phase = between(0, 6);
        c.initial = {between(-1, 1), between(-2, 2)};
        if (i % 3 == 1) c.belt = between(-0.5, 0.5);
        CAPTURE(i, table.lua_text());
        if (truth_of(c, {}).corners_passed > 4) check(c, 1e-10);
    }
}

TEST_CASE("Stribeck's law is followed where the motion passes its fall in no time", "[laws][corners][long]") {
    for (const double speed : {1.0, 0.1, 0.02}) {
        for (const double shape : {1.0, 2.0, 3.0}) {
            CAPTURE(speed, shape);
            const Stribeck law{.kinetic = 0.25, .breakaway = 0.6, .speed = speed, .shape = shape};
            const auto formula = [=](real v) -> real {
                const real x = v / speed;
                const real power = shape == 1 ? x : shape == 2 ? x * x : x * x * x;
                return 0.25L + (static_cast<real>(0.6) - 0.25L) * std::exp(-power);
            };
            const real flat = speed * std::pow(44.0L, 1 / static_cast<real>(shape));
            Case c{.law = law, .ranges = {{0, flat, formula, 0.35L * 2 / speed, speed}, {flat, HUGE_VALL, [](real) {
                                                                                             return 0.25L;
                                                                                         }}}};
            c.amplitude = 1.5;
            check(c, 1e-10);
            c.belt = 0.25;
            check(c, 1e-10);
        }
    }
}

TEST_CASE("a law with corners moves alike in all units", "[laws][corners]") {
    const auto in_units = [](double time, double torque, double angle) {
        const Tabulated table{.speed = {0, 0.05 * angle / time, 0.2 * angle / time, 0.6 * angle / time},
                              .torque = {0.6 * torque, 0.4 * torque, 0.3 * torque, 0.35 * torque}};
        const Oscillator system = Oscillator::make({.inertia = torque / angle * time * time,
                                                    .stiffness = torque / angle,
                                                    .damping = 0.02 * torque / angle * time,
                                                    .friction = table})
                                      .value();
        return must_run(system, harmonic(1.5 * torque, 0.3 / time), {0.4 * angle, 0}, {0, 60 * time}, Grid::none(),
                        Spectral{});
    };
    const Trajectory one = in_units(1, 1, 1);
    REQUIRE(one.events.size() > 5);
    for (const double time : {1e-9, 1e9}) {
        for (const double torque : {1e-9, 1e9}) {
            for (const double angle : {1e-9, 1e9}) {
                CAPTURE(time, torque, angle);
                const Trajectory other = in_units(time, torque, angle);
                REQUIRE(other.events.size() == one.events.size());
                for (std::size_t i = 0; i < one.events.size(); ++i) {
                    CHECK(other.events[i].kind == one.events[i].kind);
                    CHECK(other.events[i].t / time == within(one.events[i].t, 1e-10));
                    CHECK(other.events[i].theta / angle == within(one.events[i].theta, 1e-11));
                }
            }
        }
    }
}

TEST_CASE("a speed that only touches a corner, or stays at it, goes on", "[laws][corners]") {
    // A block pushed to the very speed of a corner, where the push balances friction.
    const Tabulated table{.speed = {0, 1, 2}, .torque = {0.5, 0.3, 0.6}};
    const Oscillator block = Oscillator::make({.inertia = 1, .stiffness = 0, .friction = table}).value();
    const Excitation push = Excitation::make(Constant{0.3}).value();
    const Trajectory run = must_run(block, push, {0, 1}, {0, 3}, Grid::every(0.5), Spectral{});
    CHECK(run.outcome == Outcome::reached_end);
    CHECK(run.state_at_stop.theta == within(3, 1e-12));
    // Above the corner friction rises: 0.3 v' = ... the speed comes back to it as exp(-0.3 t).
    const Trajectory back = must_run(block, push, {0, 1.5}, {0, 20}, Grid::every(0.5), Spectral{});
    CHECK(back.state_at_stop.velocity == within(1 + 0.5 * std::exp(-6), 1e-12));
}

}  // namespace dinal::corners_test
