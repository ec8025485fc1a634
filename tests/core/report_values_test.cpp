// The numbers of the report's cases, computed elsewhere in 80 digits, and what exact, spectral and rk4 make of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::report_values_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double pi = std::numbers::pi;

/// An integrator, and how near it comes to numbers of order one.
struct Either {
    Integrator integrator;
    double nine, ten;  ///< printed to nine places, or to ten
    double formula;    ///< given by a formula

    /// Or exact: right to rounding.
    [[nodiscard]] bool spectral() const { return !std::holds_alternative<Rk4>(integrator); }
};

/// rk4's phase error is w0 t (w0 h)^4/120 = 8.2e-11 t at h = 0.001, times an amplitude of about 1 to 2. Spectral has
/// none to speak of: what is left is half a unit of the last place printed.
const Either spectral{Spectral{}, 5.01e-10, 5.01e-11, 1e-13};
const Either closed{Exact{}, 5.01e-10, 5.01e-11, 1e-13};
const Either rk4{Rk4{0.001}, 1e-9, 1e-9, 1e-9};

/// A test that asks for it runs once with each.
Either either() {
    const int which = GENERATE(0, 1, 2);
    return which == 0 ? closed : which == 1 ? spectral : rk4;
}

Trajectory free_motion(const Either& method, double zeta, double friction_ratio) {
    return must_run(nondimensional(zeta, friction_ratio), {}, {0, 2 * pi}, {0, 5}, Grid::none(), method.integrator);
}

Trajectory driven(const Either& method, const Oscillator& system, double r, const State& initial, double t_end) {
    return must_run(system, harmonic(1, r * 2 * pi), initial, {0, t_end}, Grid::none(), method.integrator);
}

struct Expected_event {
    EventKind kind;
    double t, theta;
};

void check_events(const Trajectory& run, const std::vector<Expected_event>& expected, double near) {
    REQUIRE(run.events.size() >= expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i, name(run.events[i].kind));
        CHECK(run.events[i].kind == expected[i].kind);
        CHECK(std::fabs(run.events[i].t - expected[i].t) <= near);
        CHECK(std::fabs(run.events[i].theta - expected[i].theta) <= near);
    }
}

/// The amplitude of the last cycle of a long run: angles at events are extremes.
double last_amplitude(const Trajectory& run, double since) {
    double least = 1e9;
    double most = -1e9;
    for (const Event& event : run.events) {
        if (event.t < since) continue;
        least = std::min(least, event.theta);
        most = std::max(most, event.theta);
    }
    return (most - least) / 2;
}

long count_since(const Trajectory& run, EventKind kind, double since) {
    return std::count_if(run.events.begin(), run.events.end(),
                         [&](const Event& event) { return event.kind == kind && event.t >= since; });
}

constexpr auto turn = EventKind::turn;
constexpr auto stick = EventKind::stick;
constexpr auto slip = EventKind::slip;
constexpr auto rest = EventKind::rest;

}  // namespace

TEST_CASE("figures 16 to 18: free vibration without dry friction follows the closed forms", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    for (const double zeta : {0.239, 1.0, 2.387}) {
        const Oscillator system = nondimensional(zeta, 0);
        const Trajectory run = must_run(system, {}, {0, 2 * pi}, {0, 3}, Grid::every(0.0437), method.integrator);
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            // theta0 = 0 leaves theta'0/w1 e^(-zeta w0 t) sin w1 t and its limits.
            const double x = 2 * pi * run.rows(i, 0);
            const double w = std::sqrt(std::fabs(1 - zeta * zeta));
            const double shape = zeta < 1 ? std::sin(w * x) / w : zeta == 1 ? x : std::sinh(w * x) / w;
            CAPTURE(zeta, run.rows(i, 0));
            // The fast root of zeta = 2.387 is 4.6 w0: 4.6^4 times the error of rk4's swing, while it lasts.
            const double of_rk4 = zeta < 2 ? 1e-9 : 2e-8;
            REQUIRE(std::fabs(run.rows(i, 1) - std::exp(-zeta * x) * shape) <=
                    (method.spectral() ? method.formula : of_rk4));
        }
    }
}

TEST_CASE("figure 19: resonance with viscous damping settles at 1/(2 zeta), not at 2.12", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    // e^(-0.239 2 pi 18.4): 1e-12 of the beginning is left.
    const Trajectory exact_zeta = driven(method, nondimensional(0.239, 0), 1, {1, 0}, 20);
    CHECK(last_amplitude(exact_zeta, 18.9) == within(1 / (2 * 0.239), method.spectral() ? 5e-12 : 1e-9));
    // With C = 3, I = 1, k = 39.48 zeta is 0.23873, and sin 6.28 t is not quite resonance; that moves it by 1e-4 only.
    const Oscillator as_typed = system_of({.inertia = 1, .stiffness = 39.48, .damping = 3});
    const Trajectory typed = must_run(as_typed, harmonic(39.48, as_typed.natural_frequency()), {1, 0}, {0, 20},
                                      Grid::none(), method.integrator);
    CHECK(last_amplitude(typed, 18.9) == Approx(2.0944).epsilon(0.00002));
}

TEST_CASE("figures 3 and 3 bis: magnification and phase lag", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    for (const double zeta : {0.1, 0.3, 1.0}) {
        for (const double r : {0.4, 1.0, 1.7}) {
            const Oscillator system = nondimensional(zeta, 0);
            const double period = 1 / r;
            const double end = 40 * period;  // e^(-0.2 pi 23): 5e-7 of the start is left at worst
            const Trajectory run = driven(method, system, r, {0, 0}, end);
            const double magnification = 1 / std::hypot(1 - r * r, 2 * zeta * r);
            const double lag = std::atan2(2 * zeta * r, 1 - r * r);
            CAPTURE(zeta, r);
            CHECK(last_amplitude(run, end - 1.2 * period) == Approx(magnification).epsilon(2e-6));
            const auto events = run.events.column(0);
            const double peak =
                std::find_if(events.rbegin(), events.rend(), [](const Event& event) { return event.theta > 0; })->t;
            const double measured = std::fmod(2 * pi * r * peak - pi / 2 + 2 * pi, 2 * pi);
            CHECK(std::remainder(measured - lag, 2 * pi) == within(0, 2e-5));
        }
    }
}

TEST_CASE("to take zeta = 0 for zeta = 1 is 5 % wrong at r = 0.156 and r = 6.4", "[report]") {
    const auto error = [](double r) { return std::hypot(1 - r * r, 2 * r) / std::fabs(1 - r * r) - 1; };
    CHECK(error(0.156) == within(0.0499, 0.0001));
    CHECK(error(6.4) == within(0.0501, 0.0001));
}

TEST_CASE("figure 22: free vibration with dry friction comes to rest at 0.155151392", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = free_motion(method, 0, 0.167);
    check_events(run,
                 {{turn, 0.223664157, 0.846848608},
                  {turn, 0.723664157, -0.512848608},
                  {turn, 1.223664157, 0.178848608},
                  {rest, 1.723664157, 0.155151392}},
                 method.nine);
    CHECK(run.events.size() == 4);
    CHECK(run.outcome == Outcome::at_rest);
}

TEST_CASE("free vibration with dry friction loses 4 Rd/k per period", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = must_run(nondimensional(0, 0.01), {}, {1, 0}, {0, 30}, Grid::none(), method.integrator);
    for (std::size_t i = 0; i + 1 < run.events.size(); ++i) {
        const double turns = static_cast<double>(i + 1);
        const double amplitude = 1 - 0.02 * turns;
        CHECK(std::fabs(run.events[i].theta) == within(amplitude, method.formula));
        CHECK(run.events[i].t == within(turns / 2, 30 * method.formula));
    }
}

TEST_CASE("figure 23: resonance with little dry friction grows by pi - 4 gamma per period", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = driven(method, nondimensional(0, 0.167), 1, {1, 0}, 20);
    REQUIRE(run.events.size() > 20);
    // Printed to six places.
    constexpr double half_unit = 5.5e-7;
    CHECK(run.events[0].kind == turn);
    CHECK(run.events[0].t == within(0.265152, half_unit));
    CHECK(run.events[0].theta == within(0.664736, half_unit));
    CHECK(run.events[1].kind == stick);
    CHECK(run.events[1].t == within(0.399217, half_unit));
    CHECK(run.events[1].theta == within(0.690743, half_unit));
    CHECK(run.events[2].kind == slip);
    CHECK(run.events[2].t == within(0.412268, half_unit));
    CHECK(run.events[3].theta == within(-1.907087, half_unit));
    CHECK(run.events[4].theta == within(3.142045, half_unit));
    CHECK(run.events[5].theta == within(-4.378219, half_unit));
    const auto& e = run.events;
    const double growth = std::fabs(e[e.size() - 1].theta) - std::fabs(e[e.size() - 3].theta);
    CHECK(growth == within(pi - 4 * 0.167, 1e-4));  // reached as 1/t^2
}

TEST_CASE("figure 24: one stop per half cycle with an amplitude of 0.1291703518, not 0.14", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = driven(method, nondimensional(0, 0.836), 1, {1, 0}, 60.2);  // moving at the end
    const auto last = [&](EventKind kind) {
        const auto events = run.events.column(0);
        return *std::find_if(events.rbegin(), events.rend(), [&](const Event& e) { return e.kind == kind; });
    };
    CHECK(std::fabs(last(stick).theta) == within(0.1291703518, method.ten));
    // Printed to eight places.
    const auto phase = [](double t) { return t - std::floor(2 * t) / 2; };
    CHECK(phase(last(stick).t) == within(0.45017942, method.spectral() ? 5.01e-9 : 1e-8));
    CHECK(phase(last(slip).t) == within(0.12493764, method.spectral() ? 5.01e-9 : 1e-8));
    CHECK(count_since(run, stick, 50) == 20);
    CHECK(count_since(run, turn, 50) == 0);
    const double stuck = 0.5 - 0.45017942 + 0.12493764;
    CHECK(stuck / 0.5 == within(0.35, 0.005));
}

TEST_CASE("figure 25: what linearised friction makes of r = 1.35", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory dry = driven(method, nondimensional(0, 0.5), 1.35, {1, 0}, 400);
    CHECK(last_amplitude(dry, 398) == within(0.860792180, method.nine));
    const double linearised = std::sqrt(1 - std::pow(4 * 0.5 / pi, 2)) / std::fabs(1 - 1.35 * 1.35);
    CHECK(linearised == within(0.9376, 5e-5));
    CHECK(linearised / 0.860792180 - 1 == within(0.089, 5e-4));
    const Trajectory viscous = driven(method, nondimensional(0.242, 0), 1.35, {1, 0}, 40);
    CHECK(last_amplitude(viscous, 38.5) == within(0.9520, 5e-5));
    CHECK(last_amplitude(viscous, 38.5) / 0.860792180 - 1 == within(0.106, 5e-4));
}

TEST_CASE("figure 25: the coincidence is one of phase", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    // The fundamental over the last period, from 2700 rows (the trapezoidal rule is exact enough for a periodic curve).
    const double period = 1 / 1.35;
    const double end = 540 * period;
    std::vector<double> times;
    for (int i = 0; i < 2700; ++i) times.push_back(end - period + period * i / 2700);
    const Trajectory run = must_run(nondimensional(0, 0.5), harmonic(1, 1.35 * 2 * pi), {1, 0}, {0, end},
                                    Grid::at(times), method.integrator);
    double in_phase = 0;
    double quadrature = 0;
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const double x = 2 * pi * 1.35 * run.rows(i, 0);
        in_phase += run.rows(i, 1) * std::sin(x);
        quadrature -= run.rows(i, 1) * std::cos(x);
    }
    CHECK(std::atan2(quadrature, in_phase) * 180 / pi == within(140.69, 0.005));
    CHECK(std::atan2(2 * 0.242 * 1.35, 1 - 1.35 * 1.35) * 180 / pi == within(141.54, 0.005));
}

TEST_CASE("figure 26: free vibration with both frictions", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = free_motion(method, 0.119, 0.06);
    REQUIRE(run.events.size() == 4);
    CHECK(run.events[0].theta == within(0.793829171, method.nine));
    CHECK(run.events[1].theta == within(-0.443584361, method.nine));
    CHECK(run.events[2].theta == within(0.203231680, method.nine));
    CHECK(run.events[3].theta == within(-0.038291587, method.nine));
    CHECK(run.events[3].kind == rest);
    CHECK(run.events[3].t == within(1.733933195, method.nine));
    // Zeros of the velocity lie pi/w1 apart, dry friction or not.
    const double half = 0.5 / std::sqrt(1 - 0.119 * 0.119);
    for (std::size_t i = 1; i < 4; ++i) CHECK(run.events[i].t - run.events[i - 1].t == within(half, method.formula));
    // And three successive extremes tell both frictions.
    const double X0 = std::fabs(run.events[0].theta);
    const double X1 = std::fabs(run.events[1].theta);
    const double X2 = std::fabs(run.events[2].theta);
    const double q = (X1 - X2) / (X0 - X1);
    const double decrement = -std::log(q) / pi;
    CHECK(decrement / std::hypot(1, decrement) == within(0.119, 10 * method.formula));
    CHECK((q * X0 - X1) / (1 + q) == within(0.06, 10 * method.formula));
}

TEST_CASE("figure 27: both frictions at resonance, an amplitude of 1.9611201772 and no stops", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const Trajectory run = driven(method, nondimensional(0.119, 0.418), 1, {1, 0}, 60);
    CHECK(last_amplitude(run, 58.9) == within(1.9611201772, method.ten));
    CHECK(count_since(run, stick, 10) == 0);
}

TEST_CASE("Den Hartog's amplitudes without stops and without viscous damping", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    struct Case {
        double r, gamma, amplitude;
    };
    constexpr std::array cases{Case{0.75, 0.5, 1.972601445}, Case{0.9, 0.5, 4.215903717},  Case{1.1, 0.5, 3.561050106},
                               Case{1.25, 0.3, 1.617064871}, Case{1.35, 0.5, 0.860792180}, Case{1.5, 0.5, 0.553774924},
                               Case{2, 0.5, 0.220479276}};
    for (const Case& c : cases) {
        CAPTURE(c.r, c.gamma);
        // The closed form: V = 1/(1 - r^2), U = tan(pi/2r)/r, A = sqrt(V^2 - gamma^2 U^2).
        const double V = 1 / (1 - c.r * c.r);
        const double U = std::tan(pi / (2 * c.r)) / c.r;
        CHECK(std::sqrt(V * V - c.gamma * c.gamma * U * U) == within(c.amplitude, 5.01e-10));
        // Steady states of the same phase error of rk4: relative (w h)^4/120 against |1 - r^2|, hence the division.
        const Trajectory run = driven(method, nondimensional(0, c.gamma), c.r, {0, 0}, 800);
        const double z = method.spectral() ? 0 : 2 * pi * std::max(1.0, c.r) * 0.001;
        const double tolerance = 5e-10 + 2 * c.amplitude * std::pow(z, 4) / 120 / std::fabs(1 - c.r * c.r);
        CHECK(std::fabs(last_amplitude(run, 800 - 2 / c.r) - c.amplitude) <= tolerance);
        CHECK(count_since(run, stick, 700) == 0);
    }
}

TEST_CASE("the boundary of the motion without stops", "[report]") {
    const bool by_spectral = GENERATE(true, false);
    struct Case {
        double zeta, ratio, r, gamma;  // ratio: Re/Rd
    };
    // r = 1/2, 1/4 without viscous damping are left out: the steady state is not unique there.
    constexpr std::array cases{Case{0, 1, .6, .531513},    Case{0, 1, .7, .722070},      Case{0, 1, .8, .817406},
                               Case{0, 1, .85, .826445},   Case{0, 1, .9, .819650},      Case{0, 1, 1, pi / 4},
                               Case{0, 1, 1.1, .746772},   Case{0, 1, 1.35, .674413},    Case{0, 1, 1.5, .646579},
                               Case{0, 1, 2, .596285},     Case{0, 1, 3, 9.0 / 16},      Case{0, 1, 5, .546033},
                               Case{.119, 1, .5, .2429},   Case{.119, 1, .7, .543296},   Case{.119, 1, .9, .655531},
                               Case{.119, 1, 1, .652596},  Case{.119, 1, 1.35, .604883}, Case{.119, 1, 2, .560392},
                               Case{0, 1.25, .6, .433656}, Case{0, 1.25, .8, .772750},   Case{0, 1.25, 1.25, .686704},
                               Case{0, 1.25, 2, .565332}};
    for (const Case& c : cases) {
        CAPTURE(by_spectral, c.zeta, c.ratio, c.r, c.gamma);
        const auto stops = [&](double gamma) {
            const double end = 300 / c.r;
            const Either method{by_spectral ? Integrator{Spectral{}} : Rk4{0.004 / std::max(1.0, c.r)}, 0, 0, 0};
            const Trajectory run = driven(method, nondimensional(c.zeta, gamma, c.ratio * gamma), c.r, {0, 0}, end);
            return count_since(run, stick, end - 20 / c.r);
        };
        CHECK(stops(0.99 * c.gamma) == 0);
        CHECK(stops(1.01 * c.gamma) > 0);
    }
}

TEST_CASE("the number of stops per cycle falls as the load quickens", "[report]") {
    const Either method = either();
    CAPTURE(method.spectral());
    const auto stops = [&](double r) {
        const Trajectory run = driven(method, nondimensional(0, 0.4), r, {0, 0}, 60 / r);
        return static_cast<double>(count_since(run, stick, 20 / r)) / 40;
    };
    CHECK(stops(0.10) == within(6, 0.05));
    CHECK(stops(0.15) == within(4, 0.05));
    CHECK(stops(0.20) == within(4, 0.05));
    for (const double r : {0.25, 0.35, 0.45}) CHECK(stops(r) == within(2, 0.05));
    for (const double r : {0.55, 0.8, 1.5}) CHECK(stops(r) == 0);
}

}  // namespace dinal::report_values_test
