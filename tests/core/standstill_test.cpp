// What happens at velocity zero where M jumps there, and what a run knows about its start.
#include <cmath>
#include <numbers>

#include "analysis/stretches.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::standstill_test {

using namespace dinal::model;
using namespace dinal::motion;
using excitations::made;
using excitations::Probe;
using truth::harmonic;
using truth::must_run;
using truth::nondimensional;
using truth::system_of;

namespace {

constexpr double pi = std::numbers::pi;
Excitation feedback(std::function<double(double, const State&)> f) {
    return made(Scripted{.function = std::make_shared<Probe>(std::move(f)), .feedback = true});
}
double sgn(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

std::string kinds(std::span<const Event> events) {
    std::string text;
    for (const Event& event : events) text.append(name(event.kind)) += ' ';
    return text;
}

}  // namespace

TEST_CASE("a feedback that jumps at velocity zero rests alike in every integrator", "[standstill][spectral][rk4]") {
    // M adds 0.1 to Rd while it moves: half cycles lose 2 (Rd + 0.1), 1.1 -> -0.7 -> 0.3 -> 0.1, at 3 pi, where
    // M = 0 and the spring pulls less than Re.
    const Oscillator system = system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2});
    const Excitation M = feedback([](double, const State& y) { return -0.1 * sgn(y.velocity); });
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.01}, Rk4{0.001}, Rk4{0.0037}}) {
        const auto* rk4 = std::get_if<Rk4>(&integrator);
        // rk4: an event in the middle of a step is found to (w0 h)^4 at worst, three times. spectral: the jump is
        // passed in panels of 1e-13.
        const double near = rk4 != nullptr ? 3 * std::pow(rk4->h, 4) + 1e-12 : 1e-11;
        const Trajectory run = must_run(system, M, {1.1, 0}, {0, 30}, Grid::every(0.1), integrator);
        CAPTURE(integrator.index());
        REQUIRE(kinds(run.events) == "turn turn stick ");
        CHECK(run.outcome == Outcome::stuck_at_end);
        const double X[] = {-0.7, 0.3, 0.1};
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(run.events[i].t == within(pi * static_cast<double>(i + 1), near));
            CHECK(run.events[i].theta == within(X[i], near));
            CHECK(run.events[i].M == 0);  // asked at velocity zero
        }
        CHECK(run.rows(run.size() - 1, 2) == 0);
    }
}

TEST_CASE("a run knows whether it began stuck, whatever came later", "[standstill]") {
    const Oscillator system = nondimensional(0.05, 0.2, 0.3);
    for (const Integrator& integrator : std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.001}}) {
        CAPTURE(integrator.index());
        const auto began_stuck = [&](const Excitation& M, const State& initial, const Oscillator& s) {
            const Trajectory run = must_run(s, M, initial, {0, 3}, Grid::every(0.1), integrator);
            CHECK(analysis::stretches(run).front().stuck == run.began_stuck);
            return run.began_stuck;
        };
        CHECK(began_stuck({}, {0.1, 0}, system));
        CHECK(began_stuck(made(Step{.amplitude = 1, .at = 1}), {0, 0}, system));
        CHECK_FALSE(began_stuck({}, {1, 0}, system));
        CHECK_FALSE(began_stuck({}, {0, 1}, system));
        CHECK_FALSE(began_stuck({}, {0, 0}, nondimensional(0.05, 0)));
    }
}

}  // namespace dinal::standstill_test
