// End stops: impacts, bounces that die out, rest at a wall and the way off it, against closed forms and an integrator
// that shares nothing with ours.
#include <cmath>
#include <numbers>

#include "analysis/energy.hpp"
#include "analysis/explain.hpp"
#include "analysis/steady.hpp"
#include "model/laws/stribeck.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_stops.hpp"
#include "support/walled.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::walls_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

TEST_CASE("a free mass goes from wall to wall, slower by the restitution each time", "[walls]") {
    for (const double e : {1.0, 0.9, 0.5}) {
        for (const auto& [integrator, tolerance] : methods_at_walls) {
            const Trajectory run = must_run(walled({-0.5, 1, e}), {}, {0, 2}, {0, 20}, Grid::every(0.1), integrator);
            double t = 0.5, v = 2, wall = 1;
            std::size_t n = 0;
            while (t < 20) {
                REQUIRE(n < run.events.size());
                CHECK(run.events[n].kind == EventKind::impact);
                CHECK(run.events[n].t == within(t, 20 * tolerance));
                CHECK(run.events[n].theta == wall);
                CHECK(run.events[n].velocity == within(v, tolerance));
                v *= -e, wall = 0.5 - wall, t += 1.5 / std::fabs(v), ++n;
            }
            CHECK(run.events.size() == n);
            CHECK(run.rows.col(1).maxCoeff() <= 1);
            CHECK(run.rows.col(1).minCoeff() >= -0.5);
        }
    }
}

TEST_CASE("a ball bounces in a geometric series, and lies still when that is over", "[walls]") {
    // Dropped from 1 with g = 2: the first impact at t = 1 with velocity 2, each bounce e times as long and as fast.
    const double g = 2;
    for (const double e : {0.7, 0.3, 0.95}) {
        for (const auto& [integrator, tolerance] : methods_at_walls) {
            const Trajectory run =
                must_run(walled({0, none, e}), constant(-g), {1, 0}, {0, 50}, Grid::every(0.25), integrator);
            const std::vector<Event> impacts = of_kind(run, EventKind::impact);
            long double t = 1, v = 2;
            for (const Event& impact : impacts) {
                CHECK(impact.t == within(static_cast<double>(t), 40 * tolerance));
                CHECK(impact.velocity == within(static_cast<double>(-v), tolerance));
                v *= e, t += 2 * v / g;
            }
            REQUIRE(impacts.size() > 5);
            REQUIRE(run.events.back().kind == EventKind::rest);
            CHECK(run.events.back().t == within((1 + e) / (1 - e), 40 * tolerance));
            CHECK(run.events.back().theta == 0);
            CHECK(run.outcome == Outcome::at_rest);
            CHECK(of_kind(run, EventKind::stick).empty());
            CHECK(run.rows(run.size() - 1, 1) == 0);
            const auto energy = analysis::energy_of(run);
            if (!energy) continue;
            CHECK(energy->total.work.impacts == within(g, 1e-11));
            CHECK(energy->closure() < 1e-12);
            for (const analysis::HalfCycle& half : energy->half_cycles) {
                CHECK(std::fabs(half.balance.error()) < 1e-12);
            }
        }
    }
}

TEST_CASE("a spring behind a wall: each return by the phase of the swing", "[walls]") {
    for (const double wall : {0.5, -0.3}) {
        for (const auto& [integrator, tolerance] : methods_at_walls) {
            CAPTURE(wall);
            const double e = 0.7;
            const Trajectory run =
                must_run(walled({-none, wall, e}, 1), {}, {-1, 0}, {0, 30}, Grid::none(), integrator);
            long double t = std::numbers::pi_v<long double> - std::acos(static_cast<long double>(wall));
            long double v = std::sqrt(1 - static_cast<long double>(wall) * wall);
            const std::vector<Event> impacts = of_kind(run, EventKind::impact);
            REQUIRE(impacts.size() > 4);
            for (const Event& impact : impacts) {
                // Of a spring that presses, the last bounces take no time that could be seen.
                CHECK(impact.t == within(static_cast<double>(t), 40 * tolerance));
                CHECK(impact.velocity == within(static_cast<double>(v), 4 * tolerance));
                v *= e;
                t += 2 * std::numbers::pi_v<long double> - 2 * std::atan2(v, static_cast<long double>(wall));
            }
            if (wall > 0) {
                CHECK(run.outcome == Outcome::reached_end);
                CHECK(std::fabs(run.events.back().theta) <= 1);
                continue;
            }
            while (v > 1e-18L) {
                v *= e;
                t += 2 * std::numbers::pi_v<long double> - 2 * std::atan2(v, static_cast<long double>(wall));
            }
            CHECK(run.outcome == Outcome::at_rest);
            CHECK(run.events.back().t == within(static_cast<double>(t), 40 * tolerance));
            CHECK(run.state_at_stop.theta == wall);
        }
    }
}

TEST_CASE("dry friction shortens the bounces and holds the mass at the wall as well", "[walls]") {
    // Pressed by P: out against P + Rd, back under P - Rd.
    const double P = 1, Rd = 0.4, Re = 0.6, e = 0.8;
    for (const auto& [integrator, tolerance] : methods_at_walls) {
        const Excitation M = constant(P) + ramp(-0.1, 20);
        const Trajectory run =
            must_run(walled({-none, 0, e}, 0, Rd, Re), M, {-1, 0}, {0, 40}, Grid::every(0.5), integrator);
        const long double out = P + Rd, back = P - Rd, slower = std::sqrt(back / out);
        long double t = std::sqrt(2 / back), v = std::sqrt(2 * back);
        for (const Event& impact : of_kind(run, EventKind::impact)) {
            CHECK(impact.t == within(static_cast<double>(t), 40 * tolerance));
            CHECK(impact.velocity == within(static_cast<double>(v), 4 * tolerance));
            v *= e;
            t += v / out + v * slower / back;
            v *= slower;
        }
        const long double v1 = e * std::sqrt(2 * back);
        const long double rest = std::sqrt(2 / back) + v1 * (1 / out + slower / back) / (1 - e * slower);
        const std::vector<Event> sticks = of_kind(run, EventKind::stick), slips = of_kind(run, EventKind::slip);
        REQUIRE(sticks.size() == 1);
        CHECK(sticks[0].t == within(static_cast<double>(rest), 40 * tolerance));
        // The pull off the wall is 0.1 (t - 20) - P, and friction holds it up to Re.
        REQUIRE(slips.size() == 1);
        CHECK(slips[0].t == within(36, 1e-11));
        CHECK(slips[0].theta == 0);
        const double s = 40 - 36;  // theta'' = -(0.6 + 0.1 s) + 0.4
        CHECK(run.state_at_stop.theta == within(-0.1 * s * s - 0.1 * s * s * s / 6, 1e-9));
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const double at = run.rows(i, 0), friction = run.rows(i, 4);
            if (at > static_cast<double>(rest) && at <= 30) CHECK(friction == 0);  // the wall carries what presses
            if (at > 30 && at < 36) CHECK(friction == within(0.1 * (at - 20) - P, 1e-12));
        }
    }
}

TEST_CASE("restitution 0: the mass stays where it hits, until it is pulled off", "[walls]") {
    for (const double Re : {0.0, 0.25}) {
        for (const auto& [integrator, tolerance] : methods_at_walls) {
            const double v0 = 1, Rd = Re * 0.4;
            const Trajectory run = must_run(walled({-none, 0.5, 0}, 0, Rd, Re), ramp(-0.1, 2), {0, v0}, {0, 6},
                                            Grid::every(0.5), integrator);
            const double hit = Rd == 0 ? 0.5 : (v0 - std::sqrt(v0 * v0 - Rd)) / Rd;  // v0 t - Rd t^2/2 = 0.5
            CHECK(kinds_told(run) == "impact stick slip ");
            CHECK(run.events[0].t == within(hit, 10 * tolerance));
            CHECK(run.events[1].t == run.events[0].t);
            CHECK(run.events[2].t == within(2 + Re / 0.1, 1e-12));
            CHECK(run.rows(3, 1) == 0.5);
            CHECK(run.rows(3, 2) == 0);
        }
    }
}

TEST_CASE("systems with walls by lot move as an independent integrator says, in spectral and in rk4",
          "[walls][oracle]") {
    check_random_stops(Lots::walls, 180);
}

TEST_CASE("the story tells of walls, impacts and rest at a wall", "[walls][explain]") {
    const Oscillator ball = walled({0, none, 0.5});
    const Excitation M = constant(-2) + ramp(1, 8);
    const Trajectory run = must_run(ball, M, {1, 0}, {0, 12}, Grid::every(0.5), Spectral{});
    const std::string story = analysis::explain(run, ball, M, Spectral{});
    CAPTURE(story);
    for (const char* part : {"There is a wall at theta = 0; an impact leaves 50 % of the velocity.", "It hit the wall",
                             "first at t = 1,", "hardest with velocity -2 at t = 1.",
                             "It came to rest at the wall, theta = 0, at t = 3;", "pulled it off forward"}) {
        std::string flat = story;
        std::replace(flat.begin(), flat.end(), '\n', ' ');
        CHECK_THAT(flat, Catch::Contains(part));
    }
}

}  // namespace dinal::walls_test
