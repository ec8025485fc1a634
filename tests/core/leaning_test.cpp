// Runs of systems with walls that have more in them, and what begins at a wall.
#include <algorithm>
#include <limits>
#include <numbers>

#include "analysis/energy.hpp"
#include "analysis/explain.hpp"
#include "support/catch.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::leaning_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double none = std::numeric_limits<double>::infinity();

Oscillator walled(const Walls& walls, double k = 0, double Rd = 0, double Re = 0) {
    return system_of({.inertia = 1, .stiffness = k, .kinetic_friction = Rd, .breakaway = Re, .walls = walls});
}
Excitation constant(double level) {
    return Excitation::make(model::Constant{level}).value();
}
Excitation ramp(double slope, double at) {
    return Excitation::make(model::Ramp{.slope = slope, .at = at}).value();
}
std::vector<Event> of_kind(const Run& run, EventKind kind) {
    std::vector<Event> found;
    for (const Event& event : run.events) {
        if (event.kind == kind) found.push_back(event);
    }
    return found;
}
/// With what each is right to: times and velocities of impacts, for spectral and for rk4.
const std::vector<std::pair<Integrator, double>> methods_at_walls = {{motion::Spectral{}, 1e-12},
                                                                     {motion::Rk4{0.002}, 1e-8}};

}  // namespace

TEST_CASE("a belt carries the mass against the wall and slides along it", "[walls][belt]") {
    const double vb = 0.5, Rd = 0.3, Re = 0.4;
    model::Drive drive{ramp(-0.1, 20), {0, vb}};
    drive.belts = {constant(vb)};
    for (const double e : {0.0, 0.6}) {
        for (const auto& [integrator, tolerance] : methods_at_walls) {
            CAPTURE(e);
            const auto result =
                simulate(walled({-none, 1, e}, 0, Rd, Re), drive, {0, 30}, Grid::every(0.5), integrator);
            REQUIRE(result);
            const Run& run = *result;
            REQUIRE(run.events.size() > 2);
            CHECK(run.events[0].kind == EventKind::impact);
            CHECK(run.events[0].t == within(2, 10 * tolerance));
            CHECK(run.events[0].velocity == within(vb, tolerance));
            // Thrown back with e vb, friction of the belt brings it back in 2 e vb/Rd, and so on.
            const double rest = 2 + 2 * e * vb / Rd / (1 - e);
            const std::vector<Event> sticks = of_kind(run, EventKind::stick), slips = of_kind(run, EventKind::slip);
            REQUIRE(sticks.size() >= 1);
            CHECK(sticks[0].t == within(rest, 40 * tolerance));
            // Friction slides: it presses with Rd, no more and no less.
            REQUIRE(slips.size() == 1);
            CHECK(slips[0].t == within(23, 1e-11));
            for (Eigen::Index i = 0; i < run.size(); ++i) {
                if (run.rows(i, 0) > rest && run.rows(i, 0) < 23) {
                    CHECK(run.rows(i, 4) == Rd);
                    CHECK(run.rows(i, 1) == 1);
                    CHECK(run.rows(i, 2) == 0);
                }
            }
            const auto energy = analysis::energy_of(run);
            if (!energy) continue;
            CHECK(energy->closure() < 1e-12);
            CHECK(energy->total.work.impacts > 0);
        }
    }
}

TEST_CASE("states are integrated while the mass leans, and user events see impacts", "[walls][states]") {
    model::Drive drive{{}, {0, 1}};
    drive.states.push_back({"z", 0, written([](double, const State& y, std::span<const double>) { return y.theta; })});
    drive.events.push_back(
        {.name = "down", .when = written([](double, const State& y, std::span<const double>) { return y.velocity; })});
    const Run run = run_more(walled({-none, 0.5, 0}), drive, 4, 0.5, Spectral{});
    CHECK(run.rows(8, 6) == within(0.125 + 0.5 * 3.5, 1e-12));
    // An M that is the state lets the mass go when it says so.
    const Excitation M = feedback([](double, const State&, std::span<const double> z) { return 1 - z[0]; });
    drive.loads = {M}, drive.start_at({0.5, 0});
    const Run off = run_more(walled({-none, 0.5, 0}), drive, 5, 0.5, Spectral{});
    REQUIRE(of_kind(off, EventKind::slip).size() == 1);
    CHECK(of_kind(off, EventKind::slip)[0].t == within(2, 1e-12));
}

TEST_CASE("a mass that begins at a wall rests there, or hits it at once", "[walls]") {
    for (const auto& [integrator, tolerance] : methods_at_walls) {
        const Run pressed = must_run(walled({-1, 1, 0.5}), constant(1), {1, 0}, {0, 5}, Grid::every(1), integrator);
        CHECK(pressed.events.empty());
        CHECK(pressed.began_stuck);
        CHECK(pressed.outcome == Outcome::at_rest);
        const Run pulled = must_run(walled({-1, 1, 0.5}), constant(-1), {1, 0}, {0, 1}, Grid::every(1), integrator);
        CHECK(pulled.events.empty());
        CHECK(pulled.state_at_stop.theta == within(0.5, 10 * tolerance));
        const Run thrown = must_run(walled({-1, 1, 0.5}), {}, {1, 1}, {0, 1}, Grid::every(1), integrator);
        REQUIRE(thrown.events.size() == 1);
        CHECK(thrown.events[0].kind == EventKind::impact);
        CHECK(thrown.events[0].t == 0);
        CHECK(thrown.state_at_stop.theta == within(0.5, 10 * tolerance));
        CHECK(thrown.rows(0, 2) == -0.5);
    }
}

TEST_CASE("a load that only touches the limit does not take the mass off the wall", "[walls]") {
    // 1 + cos t comes down to 0 once in a turn, where it neither presses nor pulls.
    const Excitation M = constant(1) + harmonic(1, 1, pi / 2);
    for (const auto& [integrator, tolerance] : methods_at_walls) {
        const Run run = must_run(walled({-none, 0, 0.5}), M, {0, 0}, {0, 20}, Grid::none(), integrator);
        CHECK(run.state_at_stop.theta == within(0, 1e-12));
        CHECK(run.outcome == Outcome::at_rest);
    }
}

TEST_CASE("the story describes walls, impacts and rest at a wall", "[walls][explain]") {
    const Oscillator ball = walled({0, none, 0.5});
    const Excitation M = constant(-2) + ramp(1, 8);
    const Run run = must_run(ball, M, {1, 0}, {0, 12}, Grid::every(0.5), Spectral{});
    const std::string story = analysis::explain(run, ball, M, Spectral{});
    CAPTURE(story);
    for (const char* part : {"There is a wall at theta = 0; an impact keeps 50 % of the speed.", "It hit the wall",
                             "first at t = 1;", "the hardest impact had velocity -2, at t = 1.",
                             "It came to rest at the wall, theta = 0, at t = 3;", "pulled it off the wall forward"}) {
        std::string flat = story;
        std::replace(flat.begin(), flat.end(), '\n', ' ');
        CHECK_THAT(flat, Catch::Contains(part));
    }
}

}  // namespace dinal::leaning_test
