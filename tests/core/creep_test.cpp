// A mass that creeps is still on its way: what moves it next finds the friction of sliding, not that of rest.
#include <vector>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::creep_test {

namespace {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

/// Starts at 1.5, creeps down to Rd = 0.3, and is pulled on, or back, by `slope` (a time unit) from t = `at` on.
struct Creeper {
    double zeta, slope, at;
    [[nodiscard]] Oscillator system() const { return nondimensional(zeta, 0.3, 0.5); }
    [[nodiscard]] Excitation M() const { return Excitation::make(Ramp{.slope = slope, .at = at}).value(); }
    /// `watched`: with an event of a user that never comes, so that the engine takes the steps of rk4.
    [[nodiscard]] Run run(double end, const Integrator& method, bool watched = false) const {
        model::Drive drive{M(), {1.5, 0}};
        if (watched) {
            drive.events.push_back(
                {.name = "never", .when = written([](double t, const State&, auto) { return t + 1; })});
            return run_more(system(), drive, end, 0.25, method);
        }
        return must_run(system(), M(), {1.5, 0}, {0, end}, Grid::every(0.25), method);
    }
};

struct Way {
    Integrator method;
    bool watched = false;
};
/// rk4 comes to a velocity of 1e-14 or so, which it keeps.
std::vector<Way> ways() {
    return {{Exact{}}, {Spectral{}}, {Rk4{0.002}}, {Rk4{0.002}, true}};
}

}  // namespace

TEST_CASE("a ramp that pulls a creeping mass forward moves it at once, though Re > Rd",
          "[exact][spectral][rk4][creep][long]") {
    for (const double zeta : {1.0, 2.0}) {
        const double at = 60 * zeta, slope = -0.04;
        const Creeper creeper{zeta, slope, at};
        // From rest at its place, with the friction of sliding all the time: the answer to a ramp without friction.
        const Oscillator free = nondimensional(zeta, 0);
        for (const auto& [method, watched] : ways()) {
            CAPTURE(zeta, method.index(), watched);
            const Run run = creeper.run(at + 10, method, watched);
            CHECK(run.outcome == Outcome::reached_end);
            CHECK(run.events.empty());
            const Run answer =
                must_run(free, Excitation::make(Ramp{.slope = slope}).value(), {}, {0, 10}, Grid::every(0.25), Exact{});
            for (Eigen::Index i = 0; i < answer.size(); ++i) {
                const double theta = run.at(at + answer.rows(i, 0))->theta;
                CHECK(theta == within(0.3 + answer.rows(i, 1), std::holds_alternative<Rk4>(method) ? 1e-9 : 1e-12));
            }
        }
    }
}

TEST_CASE("a creeping mass that a ramp pulls back sticks until Re is passed on the other side",
          "[exact][spectral][rk4][creep][long]") {
    for (const double zeta : {1.0, 1.5}) {
        const double at = 60 * zeta, slope = 0.4;
        for (const auto& [method, watched] : ways()) {
            CAPTURE(zeta, method.index(), watched);
            const Run run = Creeper{zeta, slope, at}.run(at + 4, method, watched);
            REQUIRE(run.events.size() == 2);
            CHECK(run.events[0].kind == EventKind::stick);
            CHECK(run.events[0].t == within(at, 1e-3));
            CHECK(run.events[1].kind == EventKind::slip);
            // M - k theta from -0.3 to 0.5.
            CHECK(run.events[1].t == within(at + 2, 1e-9));
        }
    }
}

TEST_CASE("a mass that creeps at the end of a run is stuck there, and creeps again when the run is continued",
          "[exact][spectral][creep][resume]") {
    for (const Integrator& method : std::vector<Integrator>{Exact{}, Spectral{}}) {
        CAPTURE(method.index());
        const Creeper creeper{1.5, -0.04, 90};
        const Run first = creeper.run(80, method);
        CHECK(first.outcome == Outcome::stuck_at_end);  // the ramp is still to come
        REQUIRE(first.events.size() == 1);
        CHECK(first.events[0].kind == EventKind::stick);
        CHECK(first.events[0].t < 60);
        CHECK(first.state_at_stop.theta == within(0.3, 1e-11));
        CHECK(first.state_at_stop.velocity == 0);
        const Run whole = creeper.run(100, method);
        auto both = resume(creeper.system(), creeper.M(), first, 100, Grid::every(0.25), method);
        REQUIRE(both);
        CHECK(both->events.empty());
        CHECK(both->outcome == Outcome::reached_end);
        CHECK(both->state_at_stop.theta == within(whole.state_at_stop.theta, 1e-11));
        auto still = resume(creeper.system(), creeper.M(), first, 85, Grid::every(0.25), method);
        REQUIRE(still);
        REQUIRE(still->events.size() == 1);
        CHECK(still->events[0].kind == EventKind::stick);
        CHECK(still->events[0].t == first.events[0].t);
    }
}

}  // namespace dinal::creep_test
