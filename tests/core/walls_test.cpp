// End stops without bounces, and the story of impacts; hybrid_test.cpp has systems with walls by lot.
#include <cmath>
#include <numbers>

#include "analysis/explain.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/walled.hpp"
#include "support/within.hpp"

namespace dinal::walls_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

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

TEST_CASE("the story tells of walls, impacts and rest at a wall", "[walls][explain]") {
    const Oscillator ball = walled({0, none, 0.5});
    const Excitation M = constant(-2) + ramp(1, 8);
    const Trajectory run = must_run(ball, M, {1, 0}, {0, 12}, Grid::every(0.5), Spectral{});
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

}  // namespace dinal::walls_test
