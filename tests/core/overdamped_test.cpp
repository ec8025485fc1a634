// Far above critical damping: motions that are some 1e6 times slower than the system's own period.
#include <cmath>
#include <numbers>
#include <string>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/reference_systems.hpp"
#include "support/within.hpp"

namespace dinal::overdamped_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double damping = 2e6, omega = 1.5e-6;

/// Of I = k = 1 under sin(omega t): what it makes of the sine, and its two rates.
struct Answer {
    long double zeta = damping / 2, fast = zeta + std::sqrt(zeta * zeta - 1), slow = 1 / fast, w = omega;
    long double real = 1 - w * w, imaginary = 2 * zeta * w, size = real * real + imaginary * imaginary;
    long double in_phase = real / size, quadrature = -imaginary / size;

    [[nodiscard]] long double theta(long double t) const {
        return in_phase * std::sin(w * t) + quadrature * std::cos(w * t);
    }
    [[nodiscard]] long double velocity(long double t) const {
        return w * (in_phase * std::cos(w * t) - quadrature * std::sin(w * t));
    }
};

/// A free motion by its two parts.
struct Free {
    long double fast, slow, soon, late;
    Free(const Answer& of, long double theta, long double velocity)
        : fast(of.fast), slow(of.slow), soon(-(velocity + slow * theta) / (fast - slow)), late(theta - soon) {}
    [[nodiscard]] long double theta(long double since) const {
        return late * std::exp(-slow * since) + soon * std::exp(-fast * since);
    }
    [[nodiscard]] long double velocity(long double since) const {
        return -slow * late * std::exp(-slow * since) - fast * soon * std::exp(-fast * since);
    }
};

const Excitation M = Excitation::make(Harmonic{.amplitude = 1, .omega = omega}).value();

}  // namespace

TEST_CASE("a motion near critical damping keeps its digits on both sides of it", "[exact]") {
    for (const double beyond : {-1e-3, -1e-8, -1e-13, 0.0, 1e-13, 1e-8, 1e-3, 0.1}) {
        CAPTURE(beyond);
        const auto system = system_of({.inertia = 1, .stiffness = 1, .damping = 2 + beyond});
        const long double delta = system.damping() / 2, square = (delta - 1) * (delta + 1);
        const long double w = std::sqrt(std::fabs(square));
        const Run run = must_run(system, {}, {1, 0.5}, {0, 10}, Grid::every(0.25), Exact{});
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const long double t = run.rows(i, 0), swing = square > 0 ? std::cosh(w * t) : std::cos(w * t);
            const long double moved = w == 0 ? t : (square > 0 ? std::sinh(w * t) : std::sin(w * t)) / w;
            const long double theta = std::exp(-delta * t) * (swing + (0.5 + delta) * moved);
            CHECK(run.rows(i, 1) == within(static_cast<double>(theta), 4e-15));
        }
    }
}

TEST_CASE("a very overdamped motion over a million natural periods keeps its digits", "[exact]") {
    constexpr double start = 0.75, end = 6 * std::numbers::pi / omega;
    const auto system = system_of({.inertia = 1, .stiffness = 1, .damping = damping});
    const Run run = must_run(system, M, {start, 0}, {0, end}, Grid::every(end / 50), Exact{});
    const Answer answer;
    const Free free(answer, start - answer.theta(0), -answer.velocity(0));
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const long double t = run.rows(i, 0);
        // Some roundings of numbers near 1.
        CHECK(std::fabs(static_cast<double>(run.rows(i, 1) - (answer.theta(t) + free.theta(t)))) < 2e-15);
    }
}

TEST_CASE("a very overdamped mass slips when M passes Re, and stops at the right time", "[exact]") {
    // The velocity is soon above its own rounding, which is 1e-6 of that of theta: the slip was told when M was 3e-9
    // past Re.
    constexpr double friction = 0.1;
    const auto system = system_of({.inertia = 1, .stiffness = 1, .damping = damping, .kinetic_friction = friction});
    const Run run = must_run(system, M, {0, 0}, {0, 3 / omega}, Grid::none(), Exact{});
    std::string kinds;
    for (const Event& event : run.events) kinds.append(name(event.kind)) += ' ';
    REQUIRE(kinds == "slip stick slip ");

    const Answer answer;
    const long double slips = std::asin(static_cast<long double>(friction)) / answer.w;
    const Free free(answer, friction - answer.theta(slips), -answer.velocity(slips));
    long double before = 0.5L / answer.w, after = 3 / answer.w;
    for (int i = 0; i < 70; ++i) {
        const long double middle = (before + after) / 2;
        (answer.velocity(middle) + free.velocity(middle - slips) > 0 ? before : after) = middle;
    }
    const auto off = [&](std::size_t i, long double truth) {
        return std::fabs(static_cast<double>((run.events[i].t - truth) * answer.w));
    };
    // Radians of M: a few roundings of M.
    CHECK(off(0, slips) < 1e-15);
    CHECK(off(1, before) < 5e-15);
}

TEST_CASE("a very overdamped mass follows a line in a few arcs", "[exact]") {
    // The line's own answer is late by C/k; told by Taylor series it was followed from one 2e-7 to the next.
    constexpr double slope = 1e-6, start = 0.75, end = 8e6;
    const auto system = system_of({.inertia = 1, .stiffness = 1, .damping = damping});
    const auto line = Excitation::make(Polynomial{.coefficients = {0, slope}}).value();
    const Run run = must_run(system, line, {start, 0}, {0, end}, Grid::every(end / 50), Exact{});
    const Answer answer;
    const Free free(answer, start + slope * damping, -slope);
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const long double t = run.rows(i, 0);
        // Some roundings of numbers near 8.
        CHECK(std::fabs(static_cast<double>(run.rows(i, 1) - (slope * (t - damping) + free.theta(t)))) < 1e-14);
    }
}

TEST_CASE("an overdamped motion that comes from afar keeps its digits", "[exact][razor]") {
    // theta = Rd/k + a free motion; it never turns.
    const double I = 0.12, C = 1.25, k = 1.6, Rd = 1.8;
    const long double delta = static_cast<long double>(C) / (2 * static_cast<long double>(I)),
                      root = std::sqrt(delta * delta - static_cast<long double>(k) / static_cast<long double>(I)),
                      fast = delta + root, slow = (static_cast<long double>(k) / static_cast<long double>(I)) / fast;
    for (const double start : {1e3, 1e6, 1e12, 1e24}) {
        CAPTURE(start);
        const auto system = system_of({.inertia = I, .stiffness = k, .damping = C, .kinetic_friction = Rd});
        const Run run = must_run(system, {}, {start, 0}, {0, 100}, Grid::every(0.5), Exact{});
        const long double place = static_cast<long double>(Rd) / static_cast<long double>(k), far = start - place;
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const long double t = run.rows(i, 0);
            const long double way = far * (fast * std::exp(-slow * t) - slow * std::exp(-fast * t)) / (fast - slow);
            // Each arc decays to exp(-4) of what it was: 55 roundings, and some for each of up to 25 arcs.
            CHECK(std::fabs(static_cast<double>(run.rows(i, 1) - (place + way))) <=
                  1e-12 * static_cast<double>(place + way));
        }
        REQUIRE(run.events.size() == 1);
        CHECK(run.events[0].kind == EventKind::rest);
        CHECK(run.events[0].theta == within(static_cast<double>(place), 1e-14));
    }
}

TEST_CASE("a mass at its limit under a load that decays for ever is not checked at every moment", "[exact][razor]") {
    // It creeps to Rd/k = Re/k; the exponential is 1e-44 when it is there, and then 0.
    const auto system = system_of({.inertia = 0.12106475830078126,
                                   .stiffness = 1.5738525390625,
                                   .damping = 1.2460479736328125,
                                   .kinetic_friction = 1.790374755859375});
    const Excitation load = Excitation::make(Exponential{.amplitude = 1.09492, .tau = 0.18127, .at = -17.8864}).value();
    int looks = 0;
    const auto run =
        simulate(system, {load, {1e6, 0}}, {0, 1e12}, Grid::none(), Exact{}, [&](double) { return ++looks < 100; });
    REQUIRE(run);
    CHECK(run->outcome == Outcome::stuck_at_end);
    CHECK(looks < 100);
}

}  // namespace dinal::overdamped_test
