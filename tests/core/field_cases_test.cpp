// Cases from the field that general tools get wrong, with their closed forms.
#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::field_cases_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// What rk4 is allowed, or for the others a hundred roundings of numbers of order one.
double tolerance_of(const Integrator& integrator, double of_rk4) {
    return std::holds_alternative<Rk4>(integrator) ? of_rk4 : 1e-14;
}

}  // namespace

TEST_CASE("m = k = 1, friction 10, thrown with a speed of 5: at rest after atan(1/2), at sqrt(125) - 10", "[field]") {
    const ReferenceSystem& s = reference_system("newsgroup oscillator");
    const Integrator integrator = GENERATE(as<Integrator>{}, Exact{}, Spectral{}, Rk4{2 * std::numbers::pi / 1000});
    const Trajectory run = must_run(s, Grid::none(), integrator);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].kind == EventKind::rest);
    // One arc of 0.46 rad and amplitude 11.2: the error of rk4 is far below the rounding of these digits.
    const double near = tolerance_of(integrator, 1e-9);
    CHECK(run.events[0].t == within(std::atan(0.5), near));
    CHECK(run.events[0].theta == within(std::sqrt(125.0) - 10, near));
    CHECK(std::atan(0.5) == within(0.463647609, 5e-10));
    CHECK(std::sqrt(125.0) - 10 == within(1.180339887, 5e-10));
}

TEST_CASE("a block drawn by a spring slips and sticks in a rhythm that the parameters give", "[field]") {
    const ReferenceSystem& s = reference_system("spring-pulled block");
    const double w0 = s.oscillator.natural_frequency();
    const double v = 0.01;                       // of the drive
    const double drop = (29.43 - 19.62) / 4000;  // (Re - Rd)/k: stretch beyond the kinetic balance at release
    // theta' = v (1 - cos w0 t) + w0 drop sin w0 t = 0 again at w0 t = 2 (pi - atan(w0 drop/v)).
    const double lasts = 2 * (std::numbers::pi - std::atan(w0 * drop / v)) / w0;
    const double period = lasts + 2 * drop / v;  // stuck, until the stretch has gone from -drop to +drop
    const Integrator integrator =
        GENERATE_COPY(as<Integrator>{}, Exact{}, Spectral{}, Rk4{s.oscillator.natural_period() / 2000});
    const double near = tolerance_of(integrator, 1e-9);
    const Trajectory run = must_run(s, Grid::every(1e-4), integrator);
    REQUIRE(run.events.size() >= 9);
    CHECK(lasts == within(0.177191371, 5e-10));
    CHECK(period == within(0.667691371, 5e-10));
    CHECK(v * period == within(6.676913711e-3, 5e-13));
    CHECK(run.events[0].t == within(0.735750000, 1e-15));
    for (std::size_t i = 0; i + 2 < 9; i += 2) {
        CAPTURE(i);
        CHECK(run.events[i].kind == EventKind::slip);
        CHECK(run.events[i + 1].kind == EventKind::stick);
        CHECK(run.events[i + 1].t - run.events[i].t == within(lasts, near));
        CHECK(run.events[i + 2].t - run.events[i].t == within(period, near));
        CHECK(run.events[i + 1].theta - run.events[i].theta == within(v * period, v * near));
    }
    // Rows lie 1e-4 apart: w0^2 dt^2/8 of the peak may be missed.
    CHECK(run.column(Column::velocity).maxCoeff() == Approx(6.005899020e-2).epsilon(2e-6));
    CHECK(v + std::hypot(v, w0 * drop) == within(6.005899020e-2, 1e-11));
}

TEST_CASE("a mass at rest for 20 periods is still hit by a pulse of a twentieth of one", "[field]") {
    const Excitation pulse = Excitation::make(Pulse{.amplitude = 1, .at = 20, .width = 0.05}).value();
    const std::vector<Integrator> all{Exact{}, Spectral{}, Rk4{0.001}, Rk4{0.01}, Rk4{0.07}, Rk4{0.3}};
    for (const Integrator& integrator : all) {
        const Trajectory run = must_run(nondimensional(0, 0.167), pulse, {0, 0}, {0, 25}, Grid::none(), integrator);
        CAPTURE(integrator.index(), run.events.size());
        REQUIRE(run.events.size() == 2);
        CHECK(run.events[0].kind == EventKind::slip);
        CHECK(run.events[0].t == 20);
        CHECK(run.events[1].kind == EventKind::rest);
        CHECK(run.events[1].theta > 0.1);
        CHECK(run.outcome == Outcome::at_rest);
    }
}

}  // namespace dinal::field_cases_test
