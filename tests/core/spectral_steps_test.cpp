// A feedback that jumps along the motion: spectral against arcs put together by hand between its jumps.
#include <cmath>
#include <numbers>

#include "model/laws/stribeck.hpp"
#include "model/springs/polynomial_spring.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/reference_systems.hpp"

namespace dinal::spectral_steps_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::excitations;
using truth::system_of;

namespace {

constexpr double inertia = 1, stiffness = 4 * pi * pi, start = 1.003;

struct Encoder {
    double steps;  ///< to a radian
    double gain;   ///< of the feedback, torque per rad
    double friction;
};

struct Truth {
    long double theta, velocity;
    int crossings;
};

/// M = -gain floor(steps theta)/steps is constant from edge to edge, where the motion is a harmonic about where it
/// would come to rest: each arc ends at an edge, or where it turns. In long double, from a start at rest.
Truth by_hand(const Encoder& encoder, double length) {
    const long double k = stiffness, w = std::sqrt(k / inertia), R = encoder.friction;
    const long double half_turn = std::numbers::pi_v<long double>;
    long double t = 0, theta = start, velocity = 0, way = 0;
    auto cell = static_cast<int>(std::floor(start * encoder.steps));
    for (int crossings = 0;;) {
        const long double M = -static_cast<long double>(encoder.gain) * cell / encoder.steps;
        if (velocity == 0) {
            const long double pull = M - k * theta;
            if (std::fabs(pull) <= R) return {theta, 0, crossings};
            way = pull > 0 ? 1 : -1;
        }
        const long double middle = (M - way * R) / k, amplitude = std::hypot(theta - middle, velocity / w);
        const long double phase = std::atan2(-velocity / w, theta - middle), turn = way > 0 ? 0 : half_turn;
        const long double edge = (way > 0 ? cell + 1 : cell) / static_cast<long double>(encoder.steps);
        const long double part = (edge - middle) / amplitude;
        long double next = turn;
        if (std::fabs(part) < 1 && -way * std::acos(part) > phase) next = -way * std::acos(part);
        const bool crosses = next != turn, ends = (next - phase) / w >= length - t;
        if (ends) next = phase + w * (length - t);
        const long double place = middle + amplitude * std::cos(next), speed = -amplitude * w * std::sin(next);
        if (ends) return {place, speed, crossings};
        t += (next - phase) / w;
        theta = crosses ? edge : place;
        velocity = crosses ? speed : 0;
        if (crosses) cell += way > 0 ? 1 : -1, ++crossings;
    }
}

struct Run {
    Trajectory trajectory;
    int calls;
};

Run run(const Oscillator& system, const std::function<double(double, const State&)>& feedback, double length) {
    const auto function = std::make_shared<Probe>(feedback);
    auto result = simulate(system, made(Scripted{.function = function, .feedback = true}), {start, 0}, {0, length},
                           Grid::none(), Spectral{});
    if (!result) FAIL(result.error().sentence);
    return {std::move(result).value(), function->calls};
}

Run run(const std::function<double(double, const State&)>& feedback, double friction, double length) {
    return run(system_of({.inertia = inertia, .stiffness = stiffness, .kinetic_friction = friction}), feedback, length);
}

}  // namespace

TEST_CASE("spectral passes each step of an encoder in a feedback where it is, in some forty calls", "[spectral]") {
    for (const Encoder& encoder : {Encoder{16, 5, 0}, Encoder{256, 5, 0}, Encoder{64, 20, 0.4}, Encoder{64, 5, 0.4}}) {
        CAPTURE(encoder.steps, encoder.gain, encoder.friction);
        constexpr double length = 3;
        const Truth truth = by_hand(encoder, length);
        REQUIRE(truth.crossings > 100);
        const auto [trajectory, calls] = run(
            [&](double, const State& y) { return -encoder.gain * std::floor(y.theta * encoder.steps) / encoder.steps; },
            encoder.friction, length);
        CHECK(trajectory.outcome == Outcome::reached_end);
        // Some thousand crossings, each to a few roundings of theta and t.
        CHECK(std::fabs(trajectory.state_at_stop.theta - static_cast<double>(truth.theta)) < 1e-12);
        CHECK(std::fabs(trajectory.state_at_stop.velocity - static_cast<double>(truth.velocity)) < 1e-11);
        CHECK(calls < 70 * truth.crossings + 2000);  // these until it knows that M jumps
    }
}

TEST_CASE("spectral passes each step of a fine encoder in some ten calls", "[spectral]") {
    const Encoder encoder{20000, 5, 0.4};
    constexpr double length = 1;
    const Truth truth = by_hand(encoder, length);
    REQUIRE(truth.crossings > 50000);
    const auto [trajectory, calls] =
        run([&](double, const State& y) { return -encoder.gain * std::floor(y.theta * encoder.steps) / encoder.steps; },
            encoder.friction, length);
    CHECK(trajectory.outcome == Outcome::reached_end);
    // Each crossing leaves its jump of M, 2.5e-4, times the 1e-14 to which its time is known.
    CHECK(std::fabs(trajectory.state_at_stop.theta - static_cast<double>(truth.theta)) < 1e-12);
    CHECK(std::fabs(trajectory.state_at_stop.velocity - static_cast<double>(truth.velocity)) < 1e-11);
    CHECK(calls < 10 * truth.crossings);
}

TEST_CASE("a velocity that is fed back beside a fine encoder is a damping", "[spectral]") {
    constexpr double steps = 20000, gain = 5, C = 0.7, length = 1;
    const auto encoder = [&](const State& y) { return -gain * std::floor(y.theta * steps) / steps; };
    const auto [truth, calls_of_truth] = run(
        system_of({.inertia = inertia, .stiffness = stiffness, .damping = C}),
        [&](double, const State& y) { return encoder(y); }, length);
    const auto [trajectory, calls] =
        run([&](double, const State& y) { return encoder(y) - C * y.velocity; }, 0, length);
    // Fifty thousand jumps of 2.5e-4, each at a time known to 1e-14.
    CHECK(std::fabs(trajectory.state_at_stop.theta - truth.state_at_stop.theta) < 1e-12);
    CHECK(std::fabs(trajectory.state_at_stop.velocity - truth.state_at_stop.velocity) < 1e-11);
    CHECK(calls < 12 * calls_of_truth);
}

TEST_CASE("beside a fine encoder springs and laws of friction are passed along, in as few calls", "[spectral]") {
    // The same torques as a part of M: there they go through another way, which has its own tests.
    constexpr double steps = 20000, gain = 5, cubic = 3, Rd = 0.3, Re = 0.5, speed = 0.8, length = 0.45;
    constexpr int crossings = 38000;
    const auto encoder = [&](const State& y) { return -gain * std::floor(y.theta * steps) / steps; };
    const auto alone = [&](double, const State& y) { return encoder(y); };
    const auto compare = [&](const Run& beside, const Run& within) {
        const State &a = beside.trajectory.state_at_stop, &b = within.trajectory.state_at_stop;
        // 5e-15; 3e-13 where springs and friction went along in straight lines, up to each jump and across it.
        CHECK(std::fabs(a.theta - b.theta) < 5e-14);
        CHECK(std::fabs(a.velocity - b.velocity) < 1e-12);
        CHECK(beside.calls < 10 * crossings);  // that took thirty
    };
    const OscillatorParameters plain{.inertia = inertia, .stiffness = stiffness};
    OscillatorParameters sprung = plain, rubbed = plain, rubbed_alone = plain;
    sprung.spring = springs::PolynomialSpring{{{3, cubic}}};
    compare(run(system_of(sprung), alone, length),
            run(
                system_of(plain),
                [&](double, const State& y) { return encoder(y) - cubic * y.theta * y.theta * y.theta; }, length));
    rubbed.friction = laws::Stribeck{.kinetic = Rd, .breakaway = Re, .speed = speed};
    rubbed_alone.kinetic_friction = Rd;
    const auto falls = [&](double, const State& y) {
        const double way = y.velocity == 0 ? -1 : y.velocity < 0 ? -1 : 1, part = y.velocity / speed;
        return encoder(y) - way * (Re - Rd) * std::exp(-part * part);
    };
    compare(run(system_of(rubbed), alone, length), run(system_of(rubbed_alone), falls, length));
}

TEST_CASE("a feedback that is steep is no jump, and keeps its energy", "[spectral]") {
    // Taken for a jump where it had done an eighth of its way, it left the energy off by 2.5e-5 (at a width of 1e-5).
    constexpr double height = 5, place = 0.3, length = 2.2;
    for (const double width : {1e-4, 1e-5, 1e-6, 1e-8}) {
        CAPTURE(width);
        const auto energy = [&](const State& y) {
            const double x = (y.theta - place) / width;
            const double stored = x > 0 ? x + std::log1p(std::exp(-x)) : std::log1p(std::exp(x));
            return (inertia * y.velocity * y.velocity + stiffness * y.theta * y.theta) / 2 + height * width * stored;
        };
        const auto steep = [&](double, const State& y) { return -height / (1 + std::exp((place - y.theta) / width)); };
        const Run of_steep = run(steep, 0, length);
        CHECK(of_steep.trajectory.outcome == Outcome::reached_end);
        // Of 23: a few roundings.
        CHECK(std::fabs(energy(of_steep.trajectory.state_at_stop) - energy({start, 0})) < 5e-13);
        CHECK(of_steep.calls < 20000);
    }
}

}  // namespace dinal::spectral_steps_test
