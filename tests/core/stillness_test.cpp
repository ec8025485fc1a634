// Whether a mass that is stuck when its run ends is at rest, or may move later; how far a motion went.
#include "motion/stillness.hpp"

#include <cmath>
#include <numbers>

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"

namespace dinal::stillness_test {

using namespace dinal::model;
using namespace dinal::motion;

namespace {

/// Let go at 1 it stops at -0.6 after half a period, pi: there k theta = 0.6 is held by Re = 0.7.
const Oscillator swinging =
    Oscillator::make({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.2, .breakaway = 0.7}).value();

Excitation native(Term term) {
    return Excitation::make(std::move(term)).value();
}
Excitation wave(double amplitude, double omega, double phase = 0) {
    return native(Harmonic{.amplitude = amplitude, .omega = omega, .phase = phase});
}

Run run_of(Drive drive, double t_end, MethodView method) {
    drive.start_at({1, 0});
    return simulate(swinging, drive, {0, t_end}, Grid::none(), method).value();
}

/// The outcome of a run until t_end, the same for all integrators that may run it; its last event agrees.
Outcome outcome_of(const Drive& drive, double t_end, bool more = false) {
    const Run first = run_of(drive, t_end, Integrator(Spectral{}));
    const bool rests = first.outcome == Outcome::at_rest;
    CHECK(first.events.back().kind == (rests ? EventKind::rest : EventKind::stick));
    CHECK(run_of(drive, t_end, Integrator(Rk4{0.01})).outcome == first.outcome);
    CHECK(run_of(drive, t_end, Integrator(Rk4{0.01})).events.back().kind == first.events.back().kind);
    if (!more) CHECK(run_of(drive, t_end, Integrator(Dinal1989{.h = 0.01})).outcome == first.outcome);
    if (!more && !drive.M().has_script()) CHECK(run_of(drive, t_end, Integrator(Exact{})).outcome == first.outcome);
    return first.outcome;
}

}  // namespace

TEST_CASE("a mass that nothing can move any more is at rest, one that M may still move is stuck at the end",
          "[outcome]") {
    CHECK(outcome_of({}, 10) == Outcome::at_rest);
    // |M| up to 0.05 leaves the pull at 0.65; up to 0.2 it may be 0.8, at its period's crest.
    CHECK(outcome_of(wave(0.05, 0.06), 10) == Outcome::at_rest);
    CHECK(outcome_of(wave(-0.2, 0.06), 10) == Outcome::stuck_at_end);
    // A pulse that is still to come, and one that has passed.
    CHECK(outcome_of(native(Pulse{.amplitude = 1, .at = 20, .width = 1}), 10) == Outcome::stuck_at_end);
    CHECK(outcome_of(native(Pulse{.amplitude = 0.05, .at = 5, .width = 1}), 10) == Outcome::at_rest);
}

TEST_CASE("a function of a user may do anything later, so a mass is never at rest under one", "[outcome]") {
    CHECK(outcome_of(excitations::made(Scripted{.function = excitations::probe([](double) { return 0.0; })}), 10) ==
          Outcome::stuck_at_end);
}

TEST_CASE("a periodic M that did not move a mass in a whole period never will", "[outcome]") {
    // 0.08 (cos 2x - cos x) is between -0.09 and 0.16: at 0.55 the pull is -0.64 at most, though 0.16 the other way
    // would move it. Its period is 4.
    const double quarter = std::numbers::pi / 2, omega = quarter;
    const Excitation M = wave(-0.08, omega, quarter) + wave(0.08, 2 * omega, quarter);
    for (const double t_end : {3.9, 4.0, 12.0}) {
        const auto run = simulate(swinging, {M, {0.55, 0}}, {0, t_end}, Grid::none(), Integrator()).value();
        CHECK(run.outcome == (t_end < 4 ? Outcome::stuck_at_end : Outcome::at_rest));
        CHECK(run.events.empty());
    }
}

TEST_CASE("a belt, a base and an act may move a mass that M cannot move", "[outcome]") {
    Drive shaken, carried;
    carried.belts = {wave(0.01, 0.6)};
    CHECK(outcome_of(carried, 10, true) == Outcome::stuck_at_end);
    // A support acts as a load of -I a; see above.
    shaken.base = wave(0.05, 0.06);
    CHECK(outcome_of(shaken, 10, true) == Outcome::at_rest);
    Drive both{wave(-0.1, 0.06)};
    both.base = wave(0.1, 0.06);
    CHECK(outcome_of(both, 10, true) == Outcome::stuck_at_end);
}

TEST_CASE("a run continued from a stop, whether M may end it or not, equals one run", "[outcome][resume]") {
    const Excitation M = native(Pulse{.amplitude = 1, .at = 20, .width = 1});
    for (const double t_end : {15.0, 30.0, 60.0}) {
        const Run whole = run_of(M, t_end, Integrator(Spectral{}));
        const Run first = run_of(M, 10, Integrator(Spectral{}));
        const auto both = resume(swinging, M, first, t_end, Grid::none(), Integrator(Spectral{}));
        REQUIRE(both);
        CHECK(both->outcome == whole.outcome);
        REQUIRE(both->events.size() == whole.events.size());
        for (std::size_t i = 0; i < whole.events.size(); ++i) CHECK(both->events[i].kind == whole.events[i].kind);
    }
}

TEST_CASE("the peak of a motion includes what lies between the rows", "[outcome]") {
    const Run run = run_of({}, 10, Integrator(Spectral{}));
    CHECK(peak(run) == 1);
    // Thrown from the middle: sqrt(v^2 + (Rd/k)^2) - Rd/k, at a time that is no row; without dry friction v/w0.
    const Run thrown = simulate(swinging, {{}, {0, 3}}, {0, 10}, Grid::every(5), Integrator()).value();
    CHECK(std::fabs(peak(thrown) - (std::sqrt(9 + 0.04) - 0.2)) <= 1e-12);
}

TEST_CASE("the peak on a belt is where the mass turns against the ground, which is no event", "[outcome]") {
    // Friction from a belt that is always faster is the constant 0.2: it swings by 3 about 0.2.
    Drive drive{{}, {0.2, 3}};
    drive.belts = {native(Constant{.amplitude = 50})};
    const Run run = simulate(swinging, drive, {0, 10}, Grid::none(), Integrator(Spectral{})).value();
    CHECK(run.events.empty());
    CHECK(std::fabs(peak(run) - 3.2) <= 1e-9);
}

}  // namespace dinal::stillness_test
