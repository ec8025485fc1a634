// The responses to torques that a model lacks, against runs of systems that have them: a stiffer spring, more damping,
// less friction.
#include "analysis/misfit.hpp"

#include <cmath>

#include "analysis/least_squares.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/within.hpp"

namespace dinal::missing_torques_test {

using dinal::within;
using namespace dinal::analysis;
using namespace dinal::model;
using namespace dinal::motion;

namespace {

constexpr Eigen::Index viscous = 0, dry = 1, elastic = velocity_torques;

Excitation harmonic(double amplitude, double omega, double phase) {
    Harmonic term;
    term.amplitude = amplitude, term.omega = omega, term.phase = phase;
    return Excitation::make(term).value();
}

struct Case {
    OscillatorParameters system;
    Excitation M;
    State initial;
};

std::vector<double> times() {
    std::vector<double> t;
    constexpr int rows = 4001;
    for (int i = 0; i < rows; ++i) t.push_back(0.005 * i);
    return t;
}

Run run_of(const Case& one, const OscillatorParameters& parameters) {
    const auto system = Oscillator::make(parameters).value();
    const auto t = times();
    return simulate(system, {one.M, one.initial}, {t.front(), t.back()}, Grid::at(t), integrator_for(system, one.M))
        .value();
}

}  // namespace

TEST_CASE("a response is the change of a motion, through turns, stops and starts", "[missing_torques]") {
    const Excitation slow = harmonic(2, 0.7, 0) + harmonic(0.7, 1.9, 1);
    const std::vector<Case> cases{
        {{.inertia = 1, .stiffness = 4, .damping = 0.1, .kinetic_friction = 0.1}, Excitation(), {1, 0.3}},
        {{.inertia = 1, .stiffness = 4, .damping = 0.2, .kinetic_friction = 0.3}, slow, {0.2, 0}},
        {{.inertia = 1, .stiffness = 4, .damping = 0.2, .kinetic_friction = 0.7, .breakaway = 1}, slow, {0.2, 0}},
        {{.inertia = 1, .stiffness = 4, .damping = 9, .kinetic_friction = 0.7, .breakaway = 1}, slow, {1, 0}},
    };
    constexpr double step = 1e-7;
    for (const Case& one : cases) {
        const Run here = run_of(one, one.system);
        const auto t = times();
        const Eigen::MatrixXd found = responses(Oscillator::make(one.system).value(), one.M, here, t);
        const Eigen::VectorXd theta = here.column(Column::theta);
        const double far = theta.cwiseAbs().maxCoeff(), fast = here.column(Column::velocity).cwiseAbs().maxCoeff();
        const auto differs = [&](Eigen::Index which, OscillatorParameters other, double size) {
            if (other.breakaway && one.system.breakaway) other.breakaway = one.system.breakaway;
            const Eigen::VectorXd change = (run_of(one, other).column(Column::theta) - theta) * (size / step);
            CAPTURE(one.system.damping, which);
            CHECK((found.col(which) - change).cwiseAbs().maxCoeff() < 0.003 * change.cwiseAbs().maxCoeff());
        };
        OscillatorParameters softer = one.system, freer = one.system, smoother = one.system;
        softer.stiffness -= step;
        freer.damping -= step;
        smoother.kinetic_friction -= step;
        if (!smoother.breakaway) smoother.breakaway = one.system.kinetic_friction;
        differs(elastic, softer, 1 / far);
        differs(viscous, freer, 1 / fast);
        differs(dry, smoother, 1);
    }
}

TEST_CASE("a parameter between two jumps of the prediction is known to within their distance", "[missing_torques]") {
    constexpr double apart = 1e-3, noise = 1;
    const Prediction jumps = [](const Eigen::VectorXd& p) {
        const double off = p[0] - 1;
        return Eigen::VectorXd::Constant(4, std::fabs(off) < apart ? off : std::copysign(500, off));
    };
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(1);
    const auto slope = derivative(jumps, one, {one, 0 * one, one, 0 * one}, noise);
    REQUIRE(slope);
    CHECK(slope->norm() == within(noise / apart, 0.1 * noise / apart));
}

}  // namespace dinal::missing_torques_test
