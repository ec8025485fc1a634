// The grid of rows: exactly the times asked for, exactly t_end at the end.
#include <cmath>
#include <limits>
#include <string>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::rows_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;
using Catch::Matchers::Contains;

namespace {

std::vector<double> times_of(const Grid& grid, const Window& window) {
    const auto checked = grid.within(window);
    if (!checked) FAIL(checked.error().sentence);
    std::vector<double> times;
    for (std::size_t i = 0; i < checked->count(); ++i) times.push_back(checked->time(i));
    return times;
}

std::string refusal(const Window& window, const Grid& grid, const Limits& limits = {}, const State& initial = {1, 0}) {
    const auto run = simulate(nondimensional(0.1, 0), {{}, initial}, window, grid, Rk4{0.001}, {}, limits);
    return run ? "" : run.error().sentence;
}

}  // namespace

TEST_CASE("rows lie at t_start + i dt and the last one at t_end, exactly", "[rows]") {
    CHECK(times_of(Grid::every(0.25), {0, 1}) == std::vector<double>{0, 0.25, 0.5, 0.75, 1});
    CHECK(times_of(Grid::every(0.5), {-1, 0.5}) == std::vector<double>{-1, -0.5, 0, 0.5});
    CHECK(times_of(Grid::every(0.4), {0, 1}) == std::vector<double>{0, 0.4, 0.8, 1});
    CHECK(times_of(Grid::every(5), {0, 1}) == std::vector<double>{0, 1});
}

TEST_CASE("a dt that divides the window to rounding leaves no tiny last interval", "[rows]") {
    for (const double dt : {0.1, 0.01, 0.001, 0.3, 0.7, 1.0 / 3}) {
        for (const int n : {1, 3, 7, 10, 100, 1000, 12345}) {
            const Window window{0, n * dt};
            const auto times = times_of(Grid::every(dt), window);
            CAPTURE(dt, n);
            REQUIRE(times.size() == static_cast<std::size_t>(n) + 1);
            REQUIRE(times.back() == window.end);
        }
    }
    CHECK(times_of(Grid::every(0.1), {0, 0.3}).size() == 4);  // 3 * 0.1 > 0.3
    CHECK(times_of(Grid::every(0.01), {0, 20}).size() == 2001);
    // Late times are rounded by more than the division is.
    for (const double start : {0.1, 1e3 + 0.1, -149121.09375, 1e6 + 1.0 / 3, 1e9 + 0.7}) {
        for (const double dt : {0.1, 1e-3 / 3, 8.0299443320945283e-07}) {
            if (dt < 32 * std::numeric_limits<double>::epsilon() * std::fabs(start)) continue;
            CAPTURE(start, dt);
            CHECK(times_of(Grid::every(dt), {start, start + 16 * dt}).size() == 17);
        }
    }
}

TEST_CASE("rows increase and their times do not accumulate rounding", "[rows]") {
    const auto times = times_of(Grid::every(1e-3), {0.3, 1000.3});
    REQUIRE(times.size() == 1000001);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        REQUIRE(times[i] < times[i + 1]);
        REQUIRE(times[i] == 0.3 + static_cast<double>(i) * 1e-3);
    }
}

TEST_CASE("every integrator ends its rows at t_end, whatever h and dt", "[rows]") {
    for (const double t_end : {1.0, 0.77, 3.14159}) {
        for (const double dt : {0.01, 0.0123, 0.5, 7.0}) {
            for (const double h : {0.01, 0.0031, 0.02}) {
                for (const Integrator& integrator : std::vector<Integrator>{Rk4{h}, Dinal1989{.h = h}}) {
                    const Run run = must_run(nondimensional(0.1, 0.1), harmonic(1, 5), {1, 0}, {0, t_end},
                                             Grid::every(dt), integrator);
                    CAPTURE(t_end, dt, h, integrator.index());
                    CHECK(run.rows(run.size() - 1, 0) == t_end);
                    CHECK(run.t_stop == t_end);
                    CHECK(run.size() == static_cast<Eigen::Index>(times_of(Grid::every(dt), {0, t_end}).size()));
                }
            }
        }
    }
}

TEST_CASE("the last row of dinal1989 is the state at t_end, not that of the step beyond it", "[rows][dinal1989]") {
    // h = dt = 0.3 does not divide 1: the last row lies inside the fourth step.
    const Oscillator system = nondimensional(0, 0);
    const Run coinciding = must_run(system, {}, {1, 0}, {0, 0.1}, Grid::every(0.03), Dinal1989{.h = 0.03});
    CHECK(coinciding.rows(coinciding.size() - 1, 0) == 0.1);
    CHECK(coinciding.rows(coinciding.size() - 1, 1) == within(std::cos(2 * std::numbers::pi * 0.1), 1e-4));
}

TEST_CASE("a spacing below the resolution of the times is refused", "[rows]") {
    CHECK_THAT(refusal({1e9, 1e9 + 1e-3}, Grid::every(1e-8)), Contains("dt = 1e-08") && Contains("rounding"));
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
