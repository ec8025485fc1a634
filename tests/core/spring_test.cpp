// Springs besides k theta: against elliptic functions, the energy of each half cycle, and an integrator that shares
// nothing with ours.
#include <fmt/format.h>

#include <boost/math/special_functions/ellint_1.hpp>
#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>

#include "analysis/energy.hpp"
#include "analysis/explain.hpp"
#include "analysis/steady.hpp"
#include "model/springs/polynomial_spring.hpp"
#include "model/springs/user_spring.hpp"
#include "support/catch.hpp"
#include "support/crossing.hpp"
#include "support/measure.hpp"
#include "support/random_stops.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::spring_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using springs::PolynomialSpring;
using springs::UserSpring;

namespace {

Spring cubic(double c) {
    return PolynomialSpring{{{3, c}}};
}
Oscillator with_spring(const Spring& spring, double k, double Rd = 0, double Re = 0, double C = 0) {
    return system_of(
        {.inertia = 1, .stiffness = k, .damping = C, .kinetic_friction = Rd, .breakaway = Re, .spring = spring});
}
Spring of_function(double (*torque)(double)) {
    return UserSpring{written([torque](double theta, const State&, std::span<const double>) { return torque(theta); })};
}

/// rk4 by (w h)^4/120 over the run.
const std::vector<std::pair<Integrator, double>> methods = {{Spectral{}, 1e-12}, {Rk4{0.001}, 1e-9}};

}  // namespace

TEST_CASE("Duffing's free motion is the elliptic cosine, with and without k", "[spring]") {
    for (const auto& [I, k, c, A] : {std::tuple{1.0, 1.0, 0.5, 2.0}, std::tuple{1.0, 0.0, 1.0, 1.5},
                                     std::tuple{1.0, 4.0, -0.3, 1.0}, std::tuple{2.5, 1.0, 2.0, 1.5}}) {
        CAPTURE(I, k, c, A);
        const long double pull = static_cast<long double>(k) + static_cast<long double>(c) * A * A;
        const long double m = c * A * A / (2 * pull), w = std::sqrt(pull / I);
        for (const auto& [integrator, tolerance] : methods) {
            const Oscillator duffing = system_of({.inertia = I, .stiffness = k, .spring = cubic(c)});
            const Trajectory run = must_run(duffing, {}, {A, 0}, {0, 20}, Grid::every(0.37), integrator);
            if (m > 0) {
                const long double quarter = boost::math::ellint_1(std::sqrt(m)) / w;
                for (std::size_t i = 0; i < run.events.size(); ++i) {
                    CHECK(run.events[i].kind == EventKind::turn);
                    CHECK(run.events[i].t == within(static_cast<double>(2 * (i + 1) * quarter), 20 * tolerance));
                }
                REQUIRE(run.events.size() == static_cast<std::size_t>(20 / (2 * quarter)));
                for (Eigen::Index i = 0; i < run.size(); ++i) {
                    const long double x = w * static_cast<long double>(run.rows(i, 0));
                    const long double theta = A * boost::math::jacobi_cn(std::sqrt(m), x);
                    CHECK(run.rows(i, 1) == within(static_cast<double>(theta), 40 * tolerance));
                }
            }
            const auto potential = [linear = k, cubed = c](double theta) {
                return linear * theta * theta / 2 + cubed * std::pow(theta, 4) / 4;
            };
            for (Eigen::Index i = 0; i < run.size(); ++i) {
                const double v = run.rows(i, 2);
                CHECK(I * v * v / 2 + potential(run.rows(i, 1)) == within(potential(A), 20 * tolerance));
            }
        }
    }
}

TEST_CASE("a cubic spring and dry friction: each extreme follows from the energy that friction takes", "[spring]") {
    const double k = 0.7, c = 0.4, Rd = 0.05, Re = 0.08;
    const auto potential = [&](long double x) { return k * x * x / 2 + c * x * x * x * x / 4; };
    for (const auto& [integrator, tolerance] : methods) {
        const Trajectory run =
            must_run(with_spring(cubic(c), k, Rd, Re), {}, {1.7, 0}, {0, 200}, Grid::every(1), integrator);
        long double x = 1.7L;
        bool rests = false;
        for (std::size_t i = 0; !rests; ++i) {
            REQUIRE(i < run.events.size());
            const long double given = potential(x) - Rd * x;
            const long double next = crossing([&](long double y) { return potential(y) + Rd * y - given; }, 0.0L, x);
            rests = k * next + c * next * next * next <= Re;
            CHECK(std::fabs(run.events[i].theta) == within(static_cast<double>(next), 20 * tolerance));
            CHECK(run.events[i].kind == (rests ? EventKind::rest : EventKind::turn));
            x = next;
            if (rests) CHECK(run.events.size() == i + 1);
        }
        CHECK(run.outcome == Outcome::at_rest);
        // At rest friction balances the springs.
        const double theta = run.state_at_stop.theta;
        CHECK(run.rows(run.size() - 1, 4) == within(k * theta + c * theta * theta * theta, 1e-15));
    }
}

TEST_CASE("a double well: the mass is let go at the limit, and rests in either well", "[spring]") {
    const Spring well = PolynomialSpring{{{1, -1.0}, {3, 1.0}}};
    const Oscillator system = with_spring(well, 0, 0.05, 0.2);
    for (const auto& [integrator, tolerance] : methods) {
        // Pulled back with theta^3 - theta: it sticks where that is at most 0.2 in size, and a ramp lets it go.
        const Excitation ramp = Excitation::make(Ramp{.slope = 0.01, .at = 0}).value();
        const Trajectory held = must_run(system, ramp, {0.1, 0}, {0, 20}, Grid::none(), integrator);
        REQUIRE_FALSE(held.events.empty());
        CHECK(held.began_stuck);
        CHECK(held.events[0].kind == EventKind::slip);
        CHECK(held.events[0].t == within((0.2 + 0.001 - 0.1) / 0.01, 1e-11));
        for (const double start : {0.5, -0.5}) {
            const Trajectory run = must_run(system, {}, {start, 0}, {0, 100}, Grid::none(), integrator);
            CHECK(run.outcome == Outcome::at_rest);
            CHECK(std::fabs(run.state_at_stop.theta) == within(1, 0.12));
            CHECK(run.state_at_stop.theta * start > 0);
        }
    }
}

TEST_CASE("the energy of springs adds up, of a user's function as well", "[spring][energy]") {
    const std::vector<std::pair<const char*, Spring>> all = {
        {"cubic", cubic(0.5)},
        {"of powers", PolynomialSpring{{{1, -0.5}, {2, 0.2}, {5, 0.3}}}},
        {"sine", of_function([](double theta) { return std::sin(theta); })},
        {"clearance", of_function([](double theta) {
             return std::fabs(theta) < 0.3 ? 0.0 : 4 * (theta - std::copysign(0.3, theta));
         })},
    };
    for (const auto& [name, spring] : all) {
        CAPTURE(name);
        const Oscillator system = with_spring(spring, 0.8, 0.05, 0.1, 0.03);
        const Trajectory run = must_run(system, harmonic(0.8, 0.7), {1.3, 0}, {0, 60}, Grid::every(0.5), Spectral{});
        const auto energy = analysis::energy_of(run);
        REQUIRE(energy);
        CHECK(energy->closure() < 1e-11);  // corners of the clearance cost a panel's tolerance each
        const auto columns = analysis::energy_columns(run);
        CHECK(columns.col(static_cast<Eigen::Index>(analysis::EnergyColumn::error)).cwiseAbs().maxCoeff() <
              1e-11 * energy->flow);
        const double theta = run.rows(7, 1);
        CHECK(columns(7, static_cast<Eigen::Index>(analysis::EnergyColumn::spring)) ==
              within(0.4 * theta * theta + spring.energy(theta), 1e-15));
    }
    CHECK(of_function([](double theta) { return std::sin(theta); }).energy(2) == within(1 - std::cos(2.0), 1e-15));
    CHECK(PolynomialSpring{{{2, 3.0}, {4, 5.0}}}.energy(-2) == within(-8 - 32, 1e-13));
}

TEST_CASE("a spring in a run with more in it moves the mass as without", "[spring][hybrid]") {
    const Oscillator system = with_spring(cubic(0.6), 0.5, 0.1, 0.25, 0.05);
    const Excitation M = harmonic(0.9, 0.4);
    Extras extras;
    extras.states.push_back({"z", 0, written([](double, const State& y, std::span<const double>) { return y.theta; })});
    const Trajectory plain = must_run(system, M, {1, 0}, {0, 60}, Grid::every(1), Spectral{});
    for (const auto& [integrator, tolerance] :
         std::vector<std::pair<Integrator, double>>{{Spectral{}, 1e-11}, {Rk4{0.002}, 1e-7}}) {
        const auto more = simulate(system, M, {1, 0}, {0, 60}, Grid::every(1), integrator, {}, {}, extras);
        REQUIRE(more);
        REQUIRE(more->events.size() == plain.events.size());
        for (std::size_t i = 0; i < plain.events.size(); ++i) {
            CHECK(more->events[i].kind == plain.events[i].kind);
            CHECK(more->events[i].t == within(plain.events[i].t, 40 * tolerance));
        }
        for (Eigen::Index i = 0; i < plain.size(); ++i) {
            CHECK(more->rows(i, 1) == within(plain.rows(i, 1), tolerance));
            if (plain.rows(i, 2) == 0) CHECK(more->rows(i, 4) == within(plain.rows(i, 4), tolerance));
        }
    }
    const auto run = simulate(system, M, {1, 0}, {0, 60}, Grid::every(1), Spectral{}, {}, {}, extras);
    const auto energy = analysis::energy_of(*run);
    REQUIRE(energy);
    CHECK(energy->closure() < 1e-12);
}

TEST_CASE("the steady motion of Duffing's oscillator is the one that a long run comes to", "[spring][steady]") {
    const Oscillator system = with_spring(cubic(1), 1, 0.05, 0.05, 0.2);
    const Excitation M = harmonic(1, 0.8);
    const double period = 2 * std::numbers::pi / 0.8;
    const analysis::SteadyMotion steady =
        analysis::steady_motion({.system = system, .excitation = M, .drive = {0, period}}, {});
    REQUIRE(steady.status == analysis::SteadyStatus::steady);
    CHECK(steady.stable);
    CHECK(steady.symmetric);
    const Trajectory run = must_run(system, M, {}, {0, 60 * period}, Grid::at({60 * period}), Spectral{});
    CHECK(steady.start.theta == within(run.state_at_stop.theta, 1e-9));
    CHECK(steady.start.velocity == within(run.state_at_stop.velocity, 1e-9));
    // A load that friction can hold: the mass may stay wherever the spring pulls back with no more than is left.
    const analysis::SteadyMotion adheres = analysis::steady_motion(
        {.system = with_spring(cubic(1), 1, 0.5, 0.5), .excitation = harmonic(0.3, 0.8), .drive = {0, period}}, {});
    REQUIRE(adheres.status == analysis::SteadyStatus::adheres);
    CHECK(adheres.rest.second + std::pow(adheres.rest.second, 3) == within(0.2, 1e-9));
    CHECK(adheres.rest.first == within(-adheres.rest.second, 1e-9));
}

TEST_CASE("springs by lot move as an independent integrator says, in spectral and in rk4", "[spring][oracle]") {
    check_random_stops(Lots::springs, 120);
}

TEST_CASE("the story of a run names a spring of its own", "[spring][explain]") {
    const Excitation M;
    const Oscillator duffing = with_spring(cubic(0.4), 0.7, 0.05, 0.08), bare = with_spring(cubic(0.4), 0, 0.05, 0.08);
    const auto story = [&](const Oscillator& system) {
        return analysis::explain(must_run(system, M, {1.7, 0}, {0, 200}, Grid::every(1), Spectral{}), system, M,
                                 Spectral{});
    };
    CHECK_THAT(story(duffing), Catch::Contains("a spring besides k theta"));
    CHECK_THAT(story(duffing), Catch::Contains("|M - k theta - spring| ="));
    CHECK_THAT(story(duffing), !Catch::Contains("2 Rd/k"));
    CHECK_THAT(story(bare), Catch::Contains("a block on a spring of its own"));
    CHECK_THAT(story(bare), Catch::Contains("|M - spring| ="));
}

}  // namespace dinal::spring_test
