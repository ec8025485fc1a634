// A free decay at the times of a record against the exact engine, and against the closed form at one time after
// another.
#include "analysis/free_decay.hpp"

#include <random>
#include <vector>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "theory/theory_free.hpp"

namespace dinal::free_decay_test {

using namespace dinal::model;

namespace {

std::vector<double> even_times(double from, double dt, int count) {
    std::vector<double> t;
    for (int i = 0; i < count; ++i) t.push_back(from + i * dt);
    return t;
}

}  // namespace

TEST_CASE("a decay at the times of a record is what the exact engine says, swings, rest and all", "[identify]") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int i = 0; i < 40; ++i) {
        const double zeta = i % 5 == 0 ? 0 : i % 5 == 1 ? 1 + unit(random) : i % 5 == 2 ? 1 : 0.3 * unit(random);
        const double gamma = i % 4 == 0 ? 0 : 0.1 * unit(random), factor = i % 3 == 0 ? 1 : 1 + unit(random);
        const Oscillator system = truth::nondimensional(zeta, gamma, factor * gamma);
        const State initial{2 * unit(random) - 1, i % 7 == 0 ? 0 : 8 * (2 * unit(random) - 1)};
        std::vector<double> times = even_times(3, 0.013, 700);
        if (i % 2 == 0) {
            for (double& t : times) t += 0.005 * unit(random);
        }
        const auto theta = analysis::free_decay(system, initial, times);
        const auto run = truth::must_run(system, Excitation(), initial, {times.front(), times.back()},
                                         motion::Grid::at(times), motion::Exact{});
        const auto exact = run.column(motion::Column::theta);
        REQUIRE(theta.size() == exact.size());
        INFO("case " << i << ", zeta = " << zeta << ", gamma = " << gamma << ", factor = " << factor);
        CHECK((theta - exact).cwiseAbs().maxCoeff() < 2e-13);
    }
}

TEST_CASE("a sparse record of a long decay, one sample, and a mass that never moves", "[identify]") {
    const Oscillator slow = truth::nondimensional(1e-4, 1e-5, 1e-5);
    const std::vector<double> times = even_times(0, 97.3, 200);
    const auto theta = analysis::free_decay(slow, {1, 2}, times);
    const theory::FreeMotion motion(slow, {1, 2});
    for (std::size_t i = 0; i < times.size(); ++i) {
        CHECK(theta[static_cast<Eigen::Index>(i)] == within(motion.at(times[i]).theta, 1e-12));
    }
    CHECK(analysis::free_decay(slow, {1, 2}, std::vector<double>{5})[0] == 1);
    const Oscillator held = truth::nondimensional(0.1, 0.5, 0.5);
    for (const double y : analysis::free_decay(held, {0.4, 0}, even_times(0, 0.1, 20))) CHECK(y == 0.4);
}

}  // namespace dinal::free_decay_test
