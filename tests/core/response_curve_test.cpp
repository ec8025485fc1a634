// Branches of steady motions round their folds: against a shooting method in long double with the variational equation
// (Boost.odeint), against what a long run does on both sides of a jump, and where a mass breaks away.
#include <Eigen/LU>
#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>
#include <numbers>

#include "analysis/response_curve.hpp"
#include "model/springs.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::response_curve_test {

using namespace dinal::analysis;
using namespace dinal::model;

namespace {

constexpr double pi = std::numbers::pi;

/// I = k = 1, M = 0.5 sin(2 pi f t), with 0.5 theta^3 besides.
Oscillator duffing(double C, double Rd, double Re) {
    return truth::system_of({.inertia = 1,
                             .stiffness = 1,
                             .damping = C,
                             .kinetic_friction = Rd,
                             .breakaway = Re,
                             .spring = springs::PolynomialSpring{{{3, 0.5}}}});
}
SteadyQuestion at_frequency(const Oscillator& system, double f, double M0 = 0.5) {
    return SteadyQuestion::of(system, truth::harmonic(M0, 2 * pi * f), {0, 1 / f});
}
std::vector<double> evenly(double from, double to, int n) {
    std::vector<double> values;
    for (int i = 0; i < n; ++i) values.push_back(from + (to - from) * i / (n - 1));
    return values;
}

/// Where a period of Duffing's equation leads, with the derivative of that, by the first variation.
using Shot = std::array<long double, 6>;
Shot shot(const Shot& from, long double f, long double C) {
    namespace odeint = boost::numeric::odeint;
    Shot y = from;
    const long double omega = 2 * std::numbers::pi_v<long double> * f;
    const auto rates = [&](const Shot& x, Shot& d, long double t) {
        const long double slope = 1 + 1.5L * x[0] * x[0];
        d = {x[1], 0.5L * std::sin(omega * t) - C * x[1] - x[0] - 0.5L * x[0] * x[0] * x[0],
             x[3], -C * x[3] - slope * x[2],
             x[5], -C * x[5] - slope * x[4]};
    };
    odeint::runge_kutta_fehlberg78<Shot, long double> step;
    constexpr int steps = 300;
    for (int i = 0; i < steps; ++i) step.do_step(rates, y, i / f / steps, 1 / f / steps);
    return y;
}

/// What a periodic motion with a multiplier of 1 misses: its start twice, and det(D - 1).
Eigen::Vector3d missed(const Eigen::Vector3d& u, long double C) {
    const Shot y = shot({u[0], u[1], 1, 0, 0, 1}, u[2], C);
    return {static_cast<double>(y[0] - u[0]), static_cast<double>(y[1] - u[1]),
            static_cast<double>((y[2] - 1) * (y[5] - 1) - y[3] * y[4])};
}

const BranchPoint& fold_of(const ResponseCurve& curve, int which) {
    for (const auto& branch : curve.branches) {
        for (const BranchPoint& point : branch) {
            if (point.kind == BranchKind::fold && which-- == 0) return point;
        }
    }
    FAIL("there are fewer folds");
    return curve.branches.front().front();
}

}  // namespace

TEST_CASE("the folds of Duffing's response agree with shooting, and have a multiplier of 1", "[response]") {
    const double C = 0.1;
    const Oscillator system = duffing(C, 0, 0);
    const CurveQuestion question{.family = [&](double f) { return at_frequency(system, f); },
                                 .values = evenly(0.18, 0.34, 9)};
    const ResponseCurve curve = response_curve(question);
    REQUIRE(curve.branches.size() == 1);
    REQUIRE(curve.jumps.size() == 2);
    for (const int which : {0, 1}) {
        const BranchPoint& fold = fold_of(curve, which);
        Eigen::Vector3d u{fold.motion.start.theta, fold.motion.start.velocity, fold.parameter};
        const Eigen::Vector3d found = u;
        u += Eigen::Vector3d(1e-4, -1e-4, 1e-5);  // so that Newton has to find it itself
        for (int i = 0; i < 6; ++i) {
            Eigen::Matrix3d J;
            for (int j = 0; j < 3; ++j) {
                const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(j);
                J.col(j) = (missed(u + h, C) - missed(u - h, C)) / 2e-6;
            }
            u -= J.inverse() * missed(u, C);
        }
        INFO("fold " << which << " at f = " << fold.parameter);
        CHECK(missed(u, C).norm() < 1e-13);
        // A fixed point may miss its period by 1e-11 of the motion; the place along the branch shows in its square.
        CHECK(found[2] == within(u[2], 1e-9));
        CHECK(found[0] == within(u[0], 1e-5));
        const auto& m = fold.motion.multipliers;
        CHECK(std::min(std::abs(m[0] - 1.0), std::abs(m[1] - 1.0)) < 1e-5);
        CHECK(std::abs(m[0] * m[1] - std::exp(-C / fold.parameter)) < 1e-7);  // Liouville
    }
    CHECK(curve.jumps[0].parameter == fold_of(curve, 1).parameter);
    CHECK_FALSE(curve.jumps[0].rising);
    CHECK(curve.jumps[1].rising);
    CHECK(curve.jumps[0].to > 1.5 * curve.jumps[0].from);
    CHECK(curve.jumps[1].to < 0.3 * curve.jumps[1].from);
    // Each value asked for has a row wherever the branch passes it: once or thrice.
    for (const double f : question.values) {
        int rows = 0;
        for (const BranchPoint& point : curve.branches[0]) rows += point.asked && point.parameter == f ? 1 : 0;
        INFO("f = " << f);
        CHECK(rows == (f > curve.jumps[0].parameter && f < curve.jumps[1].parameter ? 3 : 1));
    }
}

TEST_CASE("with dry friction a motion stays on its branch before the fold and leaves it after the fold", "[response]") {
    const Oscillator system = duffing(0.05, 0.1, 0.1);
    const CurveQuestion question{.family = [&](double f) { return at_frequency(system, f); },
                                 .values = evenly(0.19, 0.38, 8)};
    const ResponseCurve curve = response_curve(question);
    REQUIRE(curve.jumps.size() == 2);
    const MotionJump& jump = curve.jumps[1];
    CHECK(jump.rising);
    const BranchPoint& fold = fold_of(curve, 0);
    for (const double off : {-2e-3, 2e-3}) {
        const double f = jump.parameter + off, T = 1 / f;
        const auto run = truth::must_run(system, truth::harmonic(0.5, 2 * pi * f), fold.motion.start, {0, 120 * T},
                                         motion::Grid::none(), motion::Rk4{0.02});
        double high = 0;
        for (const Event& event : run.events) high = event.t > 115 * T ? std::max(high, std::fabs(event.theta)) : high;
        INFO("f = " << f);
        if (off < 0) CHECK(high > 0.8 * jump.from);
        if (off > 0) CHECK(high == within(jump.to, 0.05 * jump.to));
    }
}

TEST_CASE("with Re > Rd a mass breaks away where M passes Re, and comes to rest elsewhere on the way back",
          "[response]") {
    const Oscillator system =
        truth::system_of({.inertia = 1, .stiffness = 1, .damping = 0.05, .kinetic_friction = 0.2, .breakaway = 0.3});
    const auto family = [&](double M0) { return at_frequency(system, 0.1, M0); };
    for (const bool up : {true, false}) {
        const ResponseCurve curve =
            response_curve({.family = family, .values = up ? evenly(0.02, 1.2, 31) : evenly(1.2, 0.02, 31)});
        bool down_found = false;
        for (const MotionJump& jump : curve.jumps) {
            if (jump.rising) {
                CHECK(up);
                CHECK(jump.parameter == within(0.3, 1e-8));
                CHECK(jump.from == 0);
                continue;
            }
            down_found = true;
            CHECK(jump.parameter < 0.3);
            CHECK(jump.landed.status == SteadyStatus::adheres);
            // Just above it goes on moving, just below it does not.
            SteadyQuestion question = family(jump.parameter + 2e-3);
            question.drive.start_at({jump.from, 0});
            const SteadyMotion above = steady_motion(question);
            CHECK((above.status == SteadyStatus::steady && above.amplitude > 0.8 * jump.from));
        }
        CHECK(down_found);
        CHECK((curve.jumps.size() == (up ? 2U : 1U)));
    }
}

}  // namespace dinal::response_curve_test
