// Springs besides k theta: their energy, steady motion and story; oracle_test.cpp has systems with springs by lot.
#include <cmath>

#include "analysis/energy.hpp"
#include "analysis/explain.hpp"
#include "analysis/steady.hpp"
#include "model/springs.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
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

}  // namespace

TEST_CASE("the energy of springs adds up, also with a user's function", "[spring][energy]") {
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
        const Run run = must_run(system, harmonic(0.8, 0.7), {1.3, 0}, {0, 60}, Grid::every(0.5), Spectral{});
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

TEST_CASE("the steady motion of Duffing's oscillator is the limit of a long run", "[spring][steady]") {
    const Oscillator system = with_spring(cubic(1), 1, 0.05, 0.05, 0.2);
    const Excitation M = harmonic(1, 0.8);
    const double period = 2 * std::numbers::pi / 0.8;
    const analysis::SteadyMotion steady = analysis::steady_motion(analysis::SteadyQuestion::of(system, M, {0, period}));
    REQUIRE(steady.status == analysis::SteadyStatus::steady);
    CHECK(steady.stable);
    CHECK(steady.symmetric);
    const Run run = must_run(system, M, {}, {0, 60 * period}, Grid::at({60 * period}), Spectral{});
    CHECK(steady.start.theta == within(run.state_at_stop.theta, 1e-9));
    CHECK(steady.start.velocity == within(run.state_at_stop.velocity, 1e-9));
    // A load that friction can hold: the mass may stay wherever the spring pulls back with no more than is left.
    const analysis::SteadyMotion adheres = analysis::steady_motion(
        analysis::SteadyQuestion::of(with_spring(cubic(1), 1, 0.5, 0.5), harmonic(0.3, 0.8), {0, period}));
    REQUIRE(adheres.status == analysis::SteadyStatus::adheres);
    CHECK(adheres.rest.second + std::pow(adheres.rest.second, 3) == within(0.2, 1e-9));
    CHECK(adheres.rest.first == within(-adheres.rest.second, 1e-9));
}

TEST_CASE("the story of a run names a second spring", "[spring][explain]") {
    const Excitation M;
    const Oscillator duffing = with_spring(cubic(0.4), 0.7, 0.05, 0.08), bare = with_spring(cubic(0.4), 0, 0.05, 0.08);
    const auto story = [&](const Oscillator& system) {
        return analysis::explain(must_run(system, M, {1.7, 0}, {0, 200}, Grid::every(1), Spectral{}), system, M,
                                 Spectral{});
    };
    CHECK_THAT(story(duffing), Catch::Contains("a second spring besides k theta"));
    CHECK_THAT(story(duffing), Catch::Contains("|M - k theta - spring| ="));
    CHECK_THAT(story(duffing), !Catch::Contains("2 Rd/k"));
    CHECK_THAT(story(bare), Catch::Contains("a block on a nonlinear spring"));
    CHECK_THAT(story(bare), Catch::Contains("|M - spring| ="));
}

}  // namespace dinal::spring_test
