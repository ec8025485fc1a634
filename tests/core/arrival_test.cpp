// A mass that comes to rest exactly at the limit of sticking: equality holds, however its way there was rounded.
#include <cmath>

#include "support/catch.hpp"
#include "support/measure.hpp"

namespace dinal::arrival_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

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
                    const Trajectory run = must_run(system, {}, {(Re + 2 * n * Rd) / k, 0},
                                                    {0, 10 * system.natural_period()}, Grid::none(), integrator);
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

}  // namespace dinal::arrival_test
