// The grid of rows, and a run that is stopped; tests/lua/simulate_test.lua has the times of rows.
#include <cmath>

#include "support/catch.hpp"
#include "support/systems.hpp"

namespace dinal::rows_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

std::vector<double> times_of(const Grid& grid, const Window& window) {
    const auto checked = grid.within(window);
    if (!checked) FAIL(checked.error().sentence);
    std::vector<double> times;
    for (std::size_t i = 0; i < checked->count(); ++i) times.push_back(checked->time(i));
    return times;
}

}  // namespace

TEST_CASE("rows increase and their times do not accumulate rounding", "[rows]") {
    const auto times = times_of(Grid::every(1e-3), {0.3, 1000.3});
    REQUIRE(times.size() == 1000001);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        REQUIRE(times[i] < times[i + 1]);
        REQUIRE(times[i] == 0.3 + static_cast<double>(i) * 1e-3);
    }
}

TEST_CASE("a monitor that returns false stops the run, which keeps its rows", "[rows]") {
    for (const Integrator& integrator : std::vector<Integrator>{Rk4{0.001}, Dinal1989{.h = 0.001}}) {
        const auto run = simulate(nondimensional(0.01, 0), {{}, {1, 0}}, {0, 1000}, Grid::every(0.1), integrator,
                                  [](double t) { return t < 10; });
        REQUIRE(run);
        CHECK(run->outcome == Outcome::interrupted);
        CHECK(run->t_stop >= 10);
        CHECK(run->t_stop < 11);
        CHECK(run->size() >= 100);
        CHECK(run->size() < 111);
        CHECK(run->rows.matrix().allFinite());
        CHECK(run->at(5.05));
        CHECK_FALSE(run->at(500));
    }
}

}  // namespace dinal::rows_test
