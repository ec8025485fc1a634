// What only the spectral integrator has to answer for: functions that hide their jumps, feedback, and where it gives
// up.
#include <cmath>
#include <memory>
#include <numbers>

#include "analysis/energy.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
#include "support/within.hpp"

namespace dinal::spectral_test {

using namespace dinal::analysis;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double pi = std::numbers::pi;
using excitations::made;
using excitations::Probe;

struct Script {
    std::shared_ptr<Probe> probe;
    Excitation M;
};
Script script(std::function<double(double)> f) {
    auto probe = excitations::probe(std::move(f));
    return {probe, made(Scripted{.function = probe})};
}
Excitation feedback(std::function<double(double, const State&)> f) {
    return made(Scripted{.function = std::make_shared<Probe>(std::move(f)), .feedback = true});
}
double sgn(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

Run by_spectral(const Oscillator& system, const Excitation& M, const State& initial, const Window& window,
                const Spectral& options = {}) {
    return must_run(system, M, initial, window, Grid::every((window.end - window.start) / 64), options);
}

/// Stick and slip take turns, and nothing but a slip ends a stick.
void check_order(std::span<const Event> events) {
    for (std::size_t i = 1; i < events.size(); ++i) {
        CAPTURE(i);
        REQUIRE(events[i].t >= events[i - 1].t);
        REQUIRE((events[i - 1].kind == EventKind::stick) == (events[i].kind == EventKind::slip));
    }
}

}  // namespace

// ---- the limit of sticking

TEST_CASE("a sine of amplitude Re touches the limit at any frequency and phase and releases nothing",
          "[spectral][razor]") {
    Lot lot(17);
    for (int i = 0; i < 60; ++i) {
        const double Re = lot.between(0.05, 2), Rd = i % 3 == 0 ? Re : Re * lot.between(0.1, 1);
        const Oscillator system = nondimensional(0, Rd, Re);
        const double omega = 2 * pi * lot.power_of_ten(-1, 1.5), phase = lot.between(0, 6.28);
        CAPTURE(i, Re, Rd, omega, phase);
        REQUIRE(by_spectral(system, harmonic(Re, omega, phase), {0, 0}, {0, 20}).events.empty());
        const auto same = script([=](double t) { return Re * std::sin(omega * t + phase); });
        REQUIRE(by_spectral(system, same.M, {0, 0}, {0, 20}).events.empty());
        // The spring takes half of what M may be.
        REQUIRE(by_spectral(system, harmonic(Re / 2, omega, phase), {-Re / 2, 0}, {0, 20}).events.empty());
    }
}

TEST_CASE("a sine that passes Re by a part in 1e13 releases the mass, at the right time", "[spectral][razor]") {
    Lot lot(18);
    for (const double excess : {1e-13, 1e-11, 1e-9}) {
        for (int i = 0; i < 100; ++i) {
            const double Re = lot.between(0.05, 2), omega = 2 * pi * lot.power_of_ten(-1, 1), A = Re * (1 + excess);
            const Oscillator system = nondimensional(0, Re / 2, Re);
            const Run run = by_spectral(system, harmonic(A, omega), {0, 0}, {0, 0.7 * 2 * pi / omega});
            CAPTURE(excess, i, Re, omega);
            REQUIRE_FALSE(run.events.empty());
            CHECK(run.events[0].kind == EventKind::slip);
            // M is known to a rounding or two; its slope there is A omega sqrt(2 excess).
            const double t = std::asin(Re / A) / omega;
            CHECK(run.events[0].t == within(t, 4e-16 / (omega * std::sqrt(2 * excess)) + 1e-13));
        }
    }
}

TEST_CASE("a function that stays at Re and then leaves it gently releases the mass when it leaves",
          "[spectral][razor]") {
    const Oscillator system = nondimensional(0, 0.2, 0.5);
    for (int power = 1; power <= 6; ++power) {
        const auto M = script([power](double t) { return 0.5 + std::pow(std::max(0.0, t - 0.3), power); });
        const Run run = by_spectral(system, M.M, {0, 0}, {-0.2, 0.6});
        CAPTURE(power);
        REQUIRE(run.events.size() == 1);
        CHECK(run.events[0].kind == EventKind::slip);
        // The first M above 0.5 in doubles is where the power passes half of its last place, 2^-54.
        CHECK(run.events[0].t == within(0.3 + std::pow(0x1p-54, 1.0 / power), 1e-8));
    }
}

TEST_CASE("a mass that M can never move waits for any length of time at no cost", "[spectral]") {
    const Oscillator system = nondimensional(0.05, 0.3);
    for (const Excitation& M : {harmonic(0.2, 7), harmonic(0.1, 7) + made(Square{.amplitude = 0.1, .period = 0.37}),
                                made(Chirp{.amplitude = 0.2, .from = 1, .to = 5, .duration = 10}),
                                made(Triangle{.amplitude = 0.2, .period = 3})}) {
        const Run run = must_run(system, M, {-0.05, 0}, {0, 1e8}, Grid::at({0, 0.1, 12345678.9, 1e8}), Spectral{});
        CHECK(run.outcome == Outcome::at_rest);
        CHECK(run.events.empty());
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            CHECK(run.rows(i, 3) == M.value(run.rows(i, 0)));
            CHECK(run.rows(i, 4) == -(M.value(run.rows(i, 0)) + 0.05));
        }
        CHECK(run.at(7654321.1)->theta == -0.05);
    }
    // An exponential that grows, and a ramp, have no such bound.
    const Run late = by_spectral(system, made(Exponential{.amplitude = 1e-9, .tau = -50}), {0, 0}, {0, 2000});
    REQUIRE_FALSE(late.events.empty());
    CHECK(late.events[0].t == within(50 * std::log(0.3e9), 1e-10));
}

// ---- feedback

TEST_CASE("a stiff relaxation oscillator is followed through its jumps", "[spectral][feedback]") {
    const Oscillator system = nondimensional(0.02, 0);
    const Excitation M = feedback([](double, const State& y) { return 50 * (1 - y.theta * y.theta) * y.velocity; });
    const Run run = by_spectral(system, M, {1.5, 0.2}, {0, 20});
    // Richardson's limit of classical Runge-Kutta in long double with 2 and 4 million steps.
    CHECK(run.at(10)->theta == within(1.143363102918, 1e-11));
    CHECK(run.at(12)->theta == within(-1.98732282598, 2e-10));
    CHECK(energy_of(run)->closure() < 1e-10);
}

TEST_CASE("negative damping grows until overflow without false turns", "[spectral][feedback]") {
    for (const double Rd : {0.0, 0.3}) {
        const Oscillator system = nondimensional(0.05, Rd);
        // Both roots of the free motion are real and positive: it turns once at most.
        const Excitation M = feedback([](double, const State& y) { return 2 * y.velocity; });
        const Run run = by_spectral(system, M, {1.5, 0.2}, {0, 20});
        CAPTURE(Rd);
        CHECK(run.outcome == Outcome::state_not_finite);
        CHECK(run.events.size() == 1);
        CHECK(run.rows.matrix().allFinite());
        CHECK(std::fabs(run.state_at_stop.theta) > 1e290);
        REQUIRE_FALSE(energy_of(run));
        CHECK_THAT(energy_of(run).error().sentence, Catch::Contains("beyond the range"));
    }
}

TEST_CASE("feedback that pushes at rest and holds in motion keeps a body at rest by rk4 as by spectral",
          "[rk4][feedback]") {
    for (const double zeta : {0.0, 0.05}) {
        const Excitation M = feedback([](double t, const State& y) {
            return 1.2 * std::sin(t) - 0.3 * std::exp(-std::fabs(y.velocity) / 0.1) * sgn(y.velocity);
        });
        const Run run = must_run(nondimensional(zeta, 0.3), M, {0.3, 0.2}, {0, 20}, Grid::every(0.3), Rk4{0.002});
        const Run other = by_spectral(nondimensional(zeta, 0.3), M, {0.3, 0.2}, {0, 20});
        CHECK(run.outcome == Outcome::reached_end);
        REQUIRE(run.events.size() == other.events.size());  // none for each of the motions that did not get under way
        CHECK(run.events[0].kind == EventKind::stick);
        // rk4 spreads a jump of feedback that is not read over a step
        CHECK(std::fabs(run.state_at_stop.theta - other.state_at_stop.theta) < 0.03);
    }
}

TEST_CASE("a system in equilibrium under feedback does not turn", "[spectral][feedback]") {
    const Excitation M = feedback([](double, const State& y) { return 100 * (0.5 - y.theta) - 3 * y.velocity; });
    // Damped with 3/(2 sqrt(101) I w0): at rest, to rounding, after some ten swings.
    const Run run = by_spectral(nondimensional(0, 0), M, {0, 0}, {0, 200});
    CHECK(run.outcome == Outcome::reached_end);
    CHECK(run.events.size() < 60);
    // A rounding of its torques of 50 is 50 eps/101 of angle, 1.1e-16, and the iteration stops at a hundred of them.
    CHECK(run.state_at_stop.theta == within(50.0 / 101, 1.1e-14));
}

// ---- time scales far from T0

TEST_CASE("with a nearly absent spring, stops and turns follow the load, not T0", "[spectral]") {
    // A block of mass 1 under +-1 in turn, friction 0.3: accelerations of 0.7 and 1.3 make it turn 0.7/1.3 of half a
    // period late, for the first time.
    for (const double k : {1e-6, 1e-9, 1e-14, 1e-20}) {
        const Oscillator system = system_of({.inertia = 1, .stiffness = k, .kinetic_friction = 0.3});
        const auto hidden = script([](double t) { return t - std::floor(t) < 0.5 ? 1.0 : -1.0; });
        for (const Excitation& M : {made(Square{.amplitude = 1, .period = 1}), hidden.M}) {
            const Run run = by_spectral(system, M, {0, 0}, {0, 1000});
            CAPTURE(k);
            CHECK(run.outcome == Outcome::reached_end);
            REQUIRE(run.events.size() == 1999);
            CHECK(run.events[0].t == within(0.5 + 0.5 * 0.7 / 1.3, 1e-5 * std::sqrt(k) + k + 1e-14));
        }
    }
    // Slow enough for it to stop in each half: 0.3 of friction outweighs a load of 0.25 at rest.
    const Oscillator system = system_of({.inertia = 1, .stiffness = 1e-12, .kinetic_friction = 0.3});
    const Run run = by_spectral(system, made(Square{.amplitude = 0.4, .period = 1, .duty = 0.25}), {0, 0}, {0, 20000});
    CHECK(run.outcome != Outcome::chattering);
    CHECK(run.events.size() > 20000);
    check_order(run.events);
}

// ---- stiff

TEST_CASE("a pulse shorter than the resolution of the time gives its whole impulse", "[spectral]") {
    // Of some hundred times of the last bit of t; its ends are doubles. What comes after it is a free motion.
    constexpr double at = 1, width = 0x1p-44, end = 1.3, impulse = 1;
    const Oscillator system =
        Oscillator::make({.inertia = 1 / (4 * pi * pi), .stiffness = 1, .damping = 0.1 / pi, .kinetic_friction = 0.01})
            .value();
    const ExactMotion after(system, {{at, {}}}, {0, impulse / system.inertia()}, at, end);
    const auto table = [](std::vector<double> t, std::vector<double> M, Interpolation between) {
        return std::make_shared<const Samples>(Samples{.t = std::move(t), .M = std::move(M), .interpolation = between});
    };
    const std::vector<Term> blows{
        Exponential{1 / width, width, at}, HalfSine{pi / 2 / width, at, width},
        Gaussian{1 / (std::sqrt(2 * pi) * width), at, width}, Pulse{1 / width, at, width},
        Polyline(table({at, at + width / 2, at + width}, {0, 2 / width, 0}, Interpolation::linear)),
        // Simpson's rule, of which the parabola through these is an example.
        Polyline(table({at, at + width / 2, at + width}, {0, 1.5 / width, 0}, Interpolation::cubic))};
    for (const Term& blow : blows) {
        INFO(made(blow).components().front().term.index());
        auto run = simulate(system, {made(blow), {}}, {0, end}, Grid::at({end}), Spectral{});
        REQUIRE(run);
        // It acts up to 40 widths late, in which the mass goes 40 rad per time unit.
        CHECK(run->state_at_stop.theta == within(static_cast<double>(after.at(end).theta), 1e-11));
    }
}

}  // namespace dinal::spectral_test
