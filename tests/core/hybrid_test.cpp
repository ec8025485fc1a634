// Runs with more in them: states, a moving belt, and systems of all kinds by lot.
#include <cmath>
#include <functional>

#include "analysis/energy.hpp"
#include "model/extras.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_mixed.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::hybrid_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

TEST_CASE("a run with states goes on as if it had not been interrupted", "[hybrid]") {
    const Oscillator system =
        Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2}).value();
    const Excitation M =
        feedback([](double t, const State&, std::span<const double> z) { return std::sin(0.7 * t) + z[0]; });
    Extras extras;
    extras.states.push_back({.name = "a", .start = 0.3, .rate = written([](double, const State& y, auto z) {
                                                            return -0.5 * z[0] - 0.2 * y.velocity;
                                                        })});
    const Trajectory whole = run_more(system, M, {1, 0}, 30, 0.5, Spectral{}, extras);
    const Trajectory first = run_more(system, M, {1, 0}, 11.3, 0.5, Spectral{}, extras);
    const auto both = resume(system, M, first, 30, Grid::every(0.5), Spectral{}, {}, {}, extras);
    REQUIRE(both);
    REQUIRE(both->size() == whole.size());
    CHECK((both->rows.matrix() - whole.rows.matrix()).cwiseAbs().maxCoeff() < 1e-12);
    CHECK(both->events.size() == whole.events.size());
}

TEST_CASE("a belt that starts with a jerk leaves the mass behind", "[hybrid]") {
    // The mass lies still until the belt jumps to 1, then slips backward on it: theta'' = Rd, until it is as fast.
    const Oscillator block =
        Oscillator::make({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.25, .breakaway = 0.5}).value();
    Extras extras;
    extras.belt = Excitation::make(Step{1, 2}).value();
    for (const Integrator& method : {Integrator{Spectral{}}, Integrator{Rk4{0.002}}}) {
        const Trajectory run = run_more(block, {}, {0, 0}, 10, 1, method, extras);
        REQUIRE(run.events.size() == 2);
        CHECK(run.events[0].kind == EventKind::slip);
        CHECK(run.events[0].t == 2);
        CHECK(run.events[1].t == within(6, 1e-12));
        CHECK(run.events[1].theta == within(2, 1e-12));
        CHECK(run.events[1].velocity == within(1, 1e-12));
        CHECK(run.state_at_stop.theta == within(6, 1e-12));
    }
}

TEST_CASE("systems of all kinds by lot agree with an independent integrator, event by event", "[long][hybrid][mixed]") {
    check_random_mixed(300);
}

}  // namespace dinal::hybrid_test
