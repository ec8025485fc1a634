// Events that hang on rounding: touches of velocity zero that are no stops, and a feedback whose switching is none.
#include <cmath>
#include <memory>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::rounding_events_test {

namespace {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

}  // namespace

TEST_CASE("a block drawn with Re = Rd comes down to velocity zero once a period, and never stops",
          "[long][exact][spectral][rounding]") {
    // theta' = V (1 - cos w0 t) after the slip: it only touches zero, so one event is true.
    for (const double k : {4000.0, 1.0, 37.5, 1e-3}) {
        for (const double Re : {32.7, 0.3, 19.62, 1e-6}) {
            for (const double speed : {0.01, 1.0 / 3, 2.7e-5}) {
                const Oscillator system = system_of({.inertia = 10, .stiffness = k, .kinetic_friction = Re});
                const double T0 = system.natural_period(), starts = Re / (k * speed);
                const Excitation M = Excitation::make(Ramp{.slope = k * speed}).value();
                CAPTURE(k, Re, speed);
                for (const Integrator& method : std::vector<Integrator>{Exact{}, Spectral{}}) {
                    CAPTURE(method.index());
                    const Trajectory run = must_run(system, M, {}, {0, starts + 9.4 * T0}, Grid::none(), method);
                    REQUIRE(run.events.size() == 1);
                    CHECK(run.events[0].kind == EventKind::slip);
                    CHECK(run.events[0].t == within(starts, 1e-12 * (starts + T0)));
                    CHECK(run.outcome == Outcome::reached_end);
                }
            }
        }
    }
}

TEST_CASE("a feedback that chatters is told to, and the turns of its chatter are none", "[spectral][rounding]") {
    class Sign : public UserFunction {
    public:
        double value(double t, const State& y) override {
            return 0.2 * std::sin(t) - 0.5 * (y.velocity > 0 ? 1 : y.velocity < 0 ? -1 : 0);
        }
    };
    for (const double Rd : {0.0, 0.01}) {
        const Excitation M = Excitation::make(Scripted{.function = std::make_shared<Sign>(), .feedback = true}).value();
        const Trajectory run = must_run(nondimensional(0.05, Rd), M, {1, 0}, {0, 20}, Grid::every(0.1), Spectral{});
        CAPTURE(Rd, run.t_stop);
        CHECK(run.outcome == Outcome::chattering);
        // It swings from 1 to 0 or so, 1 less a half cycle.
        CHECK(run.events.size() <= 4);
        CHECK(run.rows(run.size() - 1, 0) <= run.t_stop);
    }
}

}  // namespace dinal::rounding_events_test
