// The motion between the rows, whichever rows are requested.
#include <cmath>
#include <functional>

#include "support/catch.hpp"
#include "support/systems.hpp"

namespace dinal::order_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

struct Work {
    Oscillator system;
    Excitation M;
    State initial;
    Window window;
    double rate = 2 * std::numbers::pi;  ///< the fastest one, rad per time unit
};

Run run_of(const Work& work, const Grid& rows, const Integrator& integrator) {
    return must_run(work.system, work.M, work.initial, work.window, rows, integrator);
}

/// How far a state is from a row, as an angle.
double distance(const Work& work, const State& y, const Run& run, Eigen::Index row) {
    return std::max(std::fabs(y.theta - run.rows(row, 1)),
                    std::fabs(y.velocity - run.rows(row, 2)) / work.system.natural_frequency());
}

/// rk4's motion must be the same to the last bit. The listing counts time by adding steps, so that a row which
/// coincides with a step is the listing's own, while the same time found by interpolation is off by the roundings of
/// all those steps.
double rounding_of_time(const Work& work, const Integrator& integrator) {
    const auto* listing = std::get_if<Dinal1989>(&integrator);
    if (listing == nullptr) return 0;
    const double length = work.window.end - work.window.start;
    return length / listing->h * 1.2e-16 * work.rate * length;
}

/// Motions that stop in each half cycle, only turn, creep, stick under jumps, and stop often in a slow cycle, with each
/// integrator whose steps do not depend on rows, of about the length h.
void for_each_run(const std::function<void(const Work&, const Integrator&, double h)>& look) {
    const double w0 = 2 * std::numbers::pi;
    const Work works[] = {
        {nondimensional(0, 0.836), harmonic(1, w0), {1, 0}, {0, 20.3}},
        {nondimensional(0.119, 0.418), harmonic(1, w0), {1, 0}, {0, 20.3}},
        {nondimensional(2.387, 0), {}, {0, w0}, {0, 4.3}, 30},
        {nondimensional(0.05, 0.45, 0.6), native(Square{.amplitude = 1, .period = 1.5}), {0, 0}, {0, 9.9}},
        {nondimensional(0, 0.4), harmonic(1, 0.1 * w0), {1, 0}, {0, 25.3}},
    };
    for (const Work& work : works) {
        CAPTURE(work.window.end);
        const double h = std::min(work.system.natural_period() / 1000, rk4::stability_limit(work.system) / 10);
        const std::vector<Integrator> all{Spectral{}, Rk4{h}, Dopri5{1e-8}, Dinal1989{.h = h}};
        for (const Integrator& integrator : all) {
            CAPTURE(integrator.index());
            look(work, integrator, h);
        }
    }
}

}  // namespace

TEST_CASE("run.at has the values that a row at that time would have", "[spectral][rk4][dopri5][dinal1989][rows]") {
    for_each_run([](const Work& work, const Integrator& integrator, double /*h*/) {
        const double dt = (work.window.end - work.window.start) / 61.3;
        const Run with_rows = run_of(work, Grid::every(dt), integrator);
        const Run without = run_of(work, Grid::none(), integrator);
        for (Eigen::Index i = 0; i < with_rows.size(); ++i) {
            const auto y = without.at(with_rows.rows(i, 0));
            REQUIRE(y);
            INFO(with_rows.rows(i, 0) << ": off by " << distance(work, *y, with_rows, i));
            // M is sampled in blocks, and the last bit of a block's sines depends on where the block begins.
            REQUIRE(distance(work, *y, with_rows, i) <= 1e-15 + rounding_of_time(work, integrator));
        }
    });
}

TEST_CASE("the requested rows do not change the motion", "[spectral][rk4][dopri5][dinal1989][rows][long]") {
    for_each_run([](const Work& work, const Integrator& integrator, double h) {
        const Run none = run_of(work, Grid::none(), integrator);
        const Run some = run_of(work, Grid::every(7.3 * h), integrator);
        const Run many = run_of(work, Grid::every(0.31 * h), integrator);
        const Run steps = run_of(work, Grid::every(h), integrator);
        const std::vector<const Run*> others{&some, &many, &steps};
        for (const Run* other : others) {
            REQUIRE(none.events.size() == other->events.size());
            for (std::size_t i = 0; i < none.events.size(); ++i) {
                REQUIRE(none.events[i].t == other->events[i].t);
                REQUIRE(none.events[i].theta == other->events[i].theta);
            }
            const Eigen::Index last = other->size() - 1;
            const State at_end{some.rows(some.size() - 1, 1), some.rows(some.size() - 1, 2)};
            REQUIRE(other->rows(last, 0) == work.window.end);
            REQUIRE(distance(work, at_end, *other, last) <= rounding_of_time(work, integrator));
        }
    });
}

}  // namespace dinal::order_test
