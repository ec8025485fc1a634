// rk4 is of fourth order: through turns, sticks and slips, under a load that depends on time, between the rows.
#include <array>
#include <cmath>

#include "support/catch.hpp"
#include "support/measure.hpp"

namespace dinal::order_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// Neither natural periods nor multiples of any step: a right RK4 shows order 5 in the amplitude at a natural period,
/// and a wrong stage time could hide behind a symmetric one.
const Grid generic = Grid::at({0.137, 0.6831, 1.3719, 2.0713, 2.9137, 3.7391, 4.5173, 5.2931, 6.0377});

/// Steps to a period: odd numbers, so that no event lies on the grid.
constexpr std::array coarse_to_fine{47.3, 97.1, 193.7, 391.3, 767.9};

/// The order through three halvings and a bit.
double observed_order(const ReferenceSystem& s, const Grid& rows) {
    const ExactMotion exact = s.exact();
    std::vector<std::pair<double, double>> errors;
    for (const double n : coarse_to_fine) {
        const double h = s.oscillator.natural_period() / n;
        errors.emplace_back(h, error_of(must_run(s, rows, Rk4{h}), exact, s.oscillator));
    }
    return order_of(errors);
}

void check_order(const ReferenceSystem& s, const Grid& rows) {
    const double order = observed_order(s, rows);
    INFO(s.name << ": order " << order);
    CHECK(order > 3.7);
    CHECK(order < 4.5);
}

ReferenceSystem driven(std::string name, const Oscillator& system, double amplitude, double omega, double phase) {
    return {std::move(name),
            system,
            harmonic(amplitude, omega, phase),
            harmonic_drive(amplitude, omega, phase),
            {0.7, -1.3},
            {0, 6.1},
            2};
}

/// How far a state is from a row, as an angle in units of the system's size.
double distance(const ReferenceSystem& s, const State& y, const Trajectory& run, Eigen::Index row) {
    return std::max(std::fabs(y.theta - run.rows(row, 1)),
                    std::fabs(y.velocity - run.rows(row, 2)) / s.oscillator.natural_frequency()) /
           s.size;
}

/// rk4's motion must be the same to the last bit. The listing counts time by adding steps, so that a row which
/// coincides with a step is the listing's own, while the same time found by interpolation is off by the roundings of
/// all those steps.
double rounding_of_time(const ReferenceSystem& s, const Integrator& integrator) {
    const auto* listing = std::get_if<Dinal1989>(&integrator);
    if (listing == nullptr) return 0;
    const double steps = (s.window.end - s.window.start) / listing->h;
    return steps * 1.2e-16 * s.fastest_rate() * (s.window.end - s.window.start);
}

}  // namespace

TEST_CASE("rk4 converges with fourth order under a load that depends on time", "[order][rk4]") {
    check_order(driven("driven, no dry friction", nondimensional(0.07, 0), 1.3, 7.7, 0.4), generic);
    check_order(driven("driven, undamped", nondimensional(0, 0), 1.3, 4.1, 1.1), generic);
    check_order(driven("driven, overdamped", nondimensional(1.4, 0), 1.3, 9.1, 0.2), generic);
}

TEST_CASE("rk4 converges with fourth order through turns", "[order][rk4]") {
    const ReferenceSystem s = driven("turns", nondimensional(0.03, 0.2), 1.7, 7.3, 0.4);
    REQUIRE(s.exact().count(EventKind::turn) >= 8);
    check_order(s, generic);
    check_order(reference_system("W4: resonance, both frictions (fig 27)"), generic);
}

TEST_CASE("rk4 converges with fourth order through sticks and slips", "[order][rk4]") {
    const ReferenceSystem s = driven("stick and slip", nondimensional(0.05, 0.6, 0.7), 1.3, 2.9, 0.4);
    REQUIRE(s.exact().count(EventKind::slip) >= 4);
    check_order(s, generic);
    check_order(reference_system("W3: one stop per half cycle (fig 24)"), generic);
}

TEST_CASE("rk4 locates its events with fourth order", "[order][rk4]") {
    const ReferenceSystem s = driven("stick and slip", nondimensional(0.05, 0.6, 0.7), 1.3, 2.9, 0.4);
    const ExactMotion exact = s.exact();
    std::vector<std::pair<double, double>> in_time;
    std::vector<std::pair<double, double>> in_angle;
    for (const double n : coarse_to_fine) {
        const double h = 1 / n;
        const Trajectory run = must_run(s, Grid::none(), Rk4{h});
        REQUIRE(run.events.size() == exact.events().size());
        double time = 0;
        double angle = 0;
        for (std::size_t i = 0; i < run.events.size(); ++i) {
            time = std::max(time, std::fabs(static_cast<double>(run.events[i].t - exact.events()[i].t)));
            angle = std::max(angle, std::fabs(static_cast<double>(run.events[i].theta - exact.events()[i].theta)));
        }
        in_time.emplace_back(h, time);
        in_angle.emplace_back(h, angle);
    }
    CHECK(order_of(in_time) > 3.7);
    CHECK(order_of(in_time) < 4.5);
    CHECK(order_of(in_angle) > 3.7);
    CHECK(order_of(in_angle) < 4.5);
}

TEST_CASE("rows between the steps keep the order of rk4, dt dividing nothing", "[order][rk4][rows]") {
    const ReferenceSystem s = driven("stick and slip", nondimensional(0.05, 0.6, 0.7), 1.3, 2.9, 0.4);
    check_order(s, Grid::every(0.00713));
    check_order(driven("driven, no dry friction", nondimensional(0.07, 0), 1.3, 7.7, 0.4), Grid::every(0.00713));
}

TEST_CASE("run.at between the rows keeps the order of rk4", "[order][rk4][rows]") {
    const ReferenceSystem s = driven("stick and slip", nondimensional(0.05, 0.6, 0.7), 1.3, 2.9, 0.4);
    const ExactMotion exact = s.exact();
    std::vector<std::pair<double, double>> errors;
    for (const double n : coarse_to_fine) {
        const Trajectory run = must_run(s, Grid::every(1.0), Rk4{1 / n});
        double worst = 0;
        for (double t = 0.0137; t < 6.1; t += 0.0531) {
            const auto y = run.at(t);
            REQUIRE(y);
            const truth::Motion truth = exact.at(t);
            worst = std::max({worst, std::fabs(static_cast<double>(y->theta - truth.theta)),
                              std::fabs(static_cast<double>(y->velocity - truth.velocity)) / resonance});
        }
        errors.emplace_back(1 / n, worst);
    }
    CHECK(order_of(errors) > 3.7);
    CHECK(order_of(errors) < 4.5);
}

TEST_CASE("run.at says what a row there would have said", "[spectral][rk4][dinal1989][rows]") {
    for (const ReferenceSystem& s : reference_systems()) {
        CAPTURE(s.name);
        const double h = std::min(s.oscillator.natural_period() / 1000, rk4::stability_limit(s.oscillator) / 10);
        const std::vector<Integrator> all{Spectral{}, Rk4{h}, Dinal1989{.h = h}};
        for (const Integrator& integrator : all) {
            CAPTURE(integrator.index());
            const double dt = (s.window.end - s.window.start) / 61.3;
            const Trajectory with_rows = must_run(s, Grid::every(dt), integrator);
            const Trajectory without = must_run(s, Grid::none(), integrator);
            for (Eigen::Index i = 0; i < with_rows.size(); ++i) {
                const auto y = without.at(with_rows.rows(i, 0));
                REQUIRE(y);
                INFO(with_rows.rows(i, 0) << ": off by " << distance(s, *y, with_rows, i));
                // M is sampled in blocks, and the last bit of a block's sines depends on where the block begins.
                REQUIRE(distance(s, *y, with_rows, i) <= 1e-15 + rounding_of_time(s, integrator));
            }
        }
    }
}

TEST_CASE("the rows asked for do not change the motion", "[spectral][rk4][dinal1989][rows][long]") {
    for (const ReferenceSystem& s : reference_systems()) {
        CAPTURE(s.name);
        const double h = std::min(s.oscillator.natural_period() / 1000, rk4::stability_limit(s.oscillator) / 10);
        const std::vector<Integrator> all{Spectral{}, Rk4{h}, Dinal1989{.h = h}};
        for (const Integrator& integrator : all) {
            CAPTURE(integrator.index());
            const Trajectory none = must_run(s, Grid::none(), integrator);
            const Trajectory some = must_run(s, Grid::every(7.3 * h), integrator);
            const Trajectory many = must_run(s, Grid::every(0.31 * h), integrator);
            const Trajectory steps = must_run(s, Grid::every(h), integrator);
            const std::vector<const Trajectory*> others{&some, &many, &steps};
            for (const Trajectory* other : others) {
                REQUIRE(none.events.size() == other->events.size());
                for (std::size_t i = 0; i < none.events.size(); ++i) {
                    REQUIRE(none.events[i].t == other->events[i].t);
                    REQUIRE(none.events[i].theta == other->events[i].theta);
                }
                const Eigen::Index last = other->size() - 1;
                const State at_end{some.rows(some.size() - 1, 1), some.rows(some.size() - 1, 2)};
                REQUIRE(other->rows(last, 0) == s.window.end);
                REQUIRE(distance(s, at_end, *other, last) <= rounding_of_time(s, integrator));
            }
        }
    }
}

TEST_CASE("W3 over 1000 periods stays within 1e-9 with h = 0.001, and within 1e-5 with h = 0.01",
          "[order][rk4][long]") {
    ReferenceSystem s = reference_system("W3: one stop per half cycle (fig 24)");
    s.window.end = 1000;
    const ExactMotion exact = s.exact();
    CHECK(error_of(must_run(s, Grid::every(0.0713), Rk4{0.001}), exact, s.oscillator) <= 1e-9);
    CHECK(error_of(must_run(s, Grid::every(0.0713), Rk4{0.01}), exact, s.oscillator) <= 1e-5);
    // The same in rows at the steps themselves.
    CHECK(error_of(must_run(s, Grid::every(0.01), Rk4{0.01}), exact, s.oscillator) <= 1e-5);
}

}  // namespace dinal::order_test
