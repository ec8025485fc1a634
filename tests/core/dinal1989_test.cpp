// The museum piece: what the listing of 1989 computes, what chapter 6 of the report was computed with, and what its
// stop rule does.
#include <array>
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::dinal1989_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using Stop = Dinal1989::Stop;

namespace {

constexpr double pi = std::numbers::pi;

/// The loop DO 80 of the listing, transcribed line by line, all in double, with 2 pi in full. U = theta, V = T0 theta',
/// T = t/T0 (k = 1 = Mc, T0 = 1 in the systems below).
struct Listing {
    double DZETA = 0, ZITA = 0, SRE = 0, K = 0;
    Stop stop = Stop::listing;
    bool slip = false;
    double amplitude = 0;  // M* = amplitude sin(2 pi r T)
    double r = 1;
    double U = 0, V = 0, T = 0;

    [[nodiscard]] double F(double t) const { return 4 * pi * pi * (amplitude * std::sin(2 * pi * r * t)); }
    static double SG(double x) { return x == 0 ? 0 : x / std::fabs(x); }

    void step() {
        const double A = 2 * DZETA * 2 * pi;
        const double B = ZITA * 4 * pi * pi;
        const double C = 4 * pi * pi;
        const auto Q1 = [&](double Y) { return K * Y; };
        const auto Q2 = [&](double X, double Y, double Z) { return K * (Z - C * X - B * SG(Y) - A * Y); };
        double X = U;
        double Y = V;
        double Z = F(T);
        const double Q11 = Q1(Y);
        const double Q21 = Q2(X, Y, Z);
        X = U + Q11 / 2;
        Y = V + Q21 / 2;
        Z = F(T + K / 2);
        const double Q12 = Q1(Y);
        const double Q22 = Q2(X, Y, Z);
        X = U + Q12 / 2;
        Y = V + (slip ? Q21 : Q22) / 2;
        const double Q13 = Q1(Y);
        const double Q23 = Q2(X, Y, Z);
        X = U + Q13;
        Y = V + Q23;
        Z = F(T + K);
        const double Q14 = Q1(Y);
        const double Q24 = Q2(X, Y, Z);
        const double U1 = U;
        const double V1 = V;
        U = U + (Q11 + 2 * Q12 + 2 * Q13 + Q14) / 6;
        V = V + (Q21 + 2 * Q22 + 2 * Q23 + Q24) / 6;
        T = T + K;
        const bool slow =
            stop == Stop::listing ? std::fabs(V) <= std::fabs(V1 - V) : std::fabs(V) < std::fabs(V1 - V) / 2;
        if (slow && std::fabs(F(T) - C * U) <= SRE * 4 * pi * pi) {
            U = U1;
            V = V1;
        }
    }
};

/// theta after n steps of h from theta = 1 at rest, M = 0.
double after(const Oscillator& system, double h, int n, bool slip) {
    const double t = n * h;
    const Run run = must_run(system, {}, {1, 0}, {0, t}, Grid::at({t}), Dinal1989{.h = h, .slip = slip});
    return run.rows(0, 1);
}

/// The geometric mean growth per step of a free motion, over many steps.
double growth(const Oscillator& system, double h, int steps, bool slip) {
    const double t = steps * h;
    const Run run = must_run(system, {}, {1, 0}, {0, t}, Grid::every(h), Dinal1989{.h = h, .slip = slip});
    // Amplitude in the phase plane, compared a whole number of half turns apart as nearly as the steps allow: many.
    const auto radius = [&](Eigen::Index i) {
        return std::hypot(run.rows(i, 1), run.rows(i, 2) / system.natural_frequency());
    };
    const Eigen::Index last = run.size() - 1;
    return std::pow(radius(last) / radius(0), 1.0 / static_cast<double>(last));
}

bool diverges(double h, bool slip, double zeta) {
    return growth(nondimensional(zeta, 0), h, 2000, slip) > 1;
}

const Oscillator chapter_6 = system_of({.inertia = 1, .stiffness = 39.48});

}  // namespace

TEST_CASE("dinal1989 agrees with a plain transcription of the listing over hundreds of steps", "[dinal1989]") {
    struct Case {
        double zeta, gamma, Re, amplitude, r, theta0, velocity0, h;
    };
    constexpr std::array cases{
        Case{0.239, 0, 0, 0, 1, 0, 2 * pi, 0.01},        Case{0, 0.167, 0.167, 0, 1, 0, 2 * pi, 0.001},
        Case{0, 0.167, 0.167, 1, 1, 1, 0, 0.01},         Case{0, 0.836, 0.836, 1, 1, 1, 0, 0.01},
        Case{0.119, 0.06, 0.06, 0, 1, 0, 2 * pi, 0.002}, Case{0.119, 0.418, 0.45, 1, 1, 1, 0, 0.01},
        Case{0, 0.5, 0.5, 1, 1.35, 1, 0, 0.01},          Case{0.05, 0.3, 0.6, 1, 0.3, 0, 0, 0.007}};
    for (const Case& c : cases) {
        for (const Stop stop : {Stop::listing, Stop::text}) {
            for (const bool slip : {false, true}) {
                CAPTURE(c.zeta, c.gamma, c.h, slip, stop == Stop::text);
                Listing listing{.DZETA = c.zeta,
                                .ZITA = c.gamma,
                                .SRE = c.Re,
                                .K = c.h,
                                .stop = stop,
                                .slip = slip,
                                .amplitude = c.amplitude,
                                .r = c.r,
                                .U = c.theta0,
                                .V = c.velocity0};
                constexpr int steps = 700;
                const Run run =
                    must_run(nondimensional(c.zeta, c.gamma, c.Re), harmonic(c.amplitude, 2 * pi * c.r),
                             {c.theta0, c.velocity0}, {0, steps * c.h}, Grid::every(c.h), Dinal1989{c.h, stop, slip});
                REQUIRE(run.size() == steps + 1);
                for (int i = 0; i <= steps; ++i) {
                    CAPTURE(i);
                    // 2 pi has 12 digits in the listing, which dinal keeps: 7e-14 of the 44 rad of 7 periods.
                    REQUIRE(std::fabs(run.rows(i, 1) - listing.U) <= 2e-11);
                    REQUIRE(std::fabs(run.rows(i, 2) - listing.V) <= 2e-10);
                    REQUIRE(run.rows(i, 3) == within(c.amplitude * std::sin(2 * pi * c.r * i * c.h), 1e-11));
                    REQUIRE(run.rows(i, 4) == 0.0 - c.gamma * Listing::SG(listing.V));
                    listing.step();
                }
                // An event is told at the end of the step in which the velocity has changed its sign.
                for (const Event& event : run.events) {
                    const auto i = static_cast<Eigen::Index>(std::lround(event.t / c.h));
                    CHECK(event.theta == run.rows(i, 1));
                    if (event.kind == EventKind::turn) CHECK(run.rows(i - 1, 2) * run.rows(i, 2) < 0);
                }
            }
        }
    }
}

TEST_CASE("one wrong index in stage 3 gives the numbers of chapter 6 of the 1989 report", "[dinal1989]") {
    // In units of 1, not of T0, which is 0.99998 with k = 39.48: the last digits tell.
    CHECK(after(chapter_6, 0.1, 5, true) == within(-1.0143600, 5e-8));
    CHECK(after(chapter_6, 0.01, 50, true) == within(-1.0000161, 5e-8));
    CHECK(after(chapter_6, 0.001, 500, true) == within(-1.000000014, 5e-10));
}

TEST_CASE("chapter 6 of the 1989 report: growth without damping and too slow a decay with it", "[dinal1989]") {
    const Oscillator undamped = nondimensional(0, 0);
    const Oscillator damped = nondimensional(0.02387, 0);
    CHECK(growth(undamped, 0.1, 2000, true) == within(1.0030, 5e-5));
    CHECK(growth(undamped, 0.1, 2000, false) < 1);
    CHECK(growth(damped, 0.1, 1000, true) == within(0.98720, 2e-5));
    CHECK(growth(damped, 0.1, 1000, false) == within(0.98480, 2e-5));
    CHECK(std::exp(-0.02387 * 2 * pi * 0.1) == within(0.98511, 5e-6));  // the truth
}

TEST_CASE("the method of chapter 6 of the 1989 report diverges from h = 0.196 on, the printed listing from 0.457 on",
          "[dinal1989]") {
    CHECK_FALSE(diverges(0.195, true, 0.02387));
    CHECK(diverges(0.197, true, 0.02387));
    CHECK_FALSE(diverges(0.456, false, 0.02387));
    CHECK(diverges(0.458, false, 0.02387));
    // Without damping: 2 sqrt 2/w0 for Runge-Kutta, any step for the slip.
    CHECK_FALSE(diverges(0.4500, false, 0));
    CHECK(diverges(0.4503, false, 0));
    CHECK(diverges(0.05, true, 0));
}

TEST_CASE("a step far beyond stability is a result of dinal1989, not an error", "[dinal1989]") {
    const Run run = must_run(nondimensional(0, 0), {}, {1, 0}, {0, 5000}, Grid::every(1), Dinal1989{.h = 1});
    CHECK(run.outcome == Outcome::state_not_finite);
    CHECK(run.size() > 10);
    CHECK(run.rows.matrix().allFinite());
    CHECK_FALSE(simulate(nondimensional(0, 0), {{}, {1, 0}}, {0, 50}, Grid::every(1), Rk4{1}));
}

}  // namespace dinal::dinal1989_test
