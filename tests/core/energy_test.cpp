// run:energy(): every joule that M puts in is found again, in closed forms and in what adds up.
#include "analysis/energy.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/written.hpp"

namespace dinal::energy_test {

using namespace dinal::analysis;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr double pi = std::numbers::pi;
/// The promise: nothing that flowed is lost but this part. What is found is near 1e-15, the rounding of a panel.
constexpr double promised = 1e-12;
/// For closed forms: the motion is right to 1e-13 or so of its amplitude, and energies are squares of it.
constexpr double near = 1e-12;

Energy energy_of_run(const Oscillator& system, const Excitation& M, const State& initial, const Window& window) {
    const Run run = must_run(system, M, initial, window, Grid::none(), Spectral{});
    auto energy = energy_of(run);
    if (!energy) FAIL(energy.error().sentence);
    return std::move(energy).value();
}

/// All that must hold of any energy: the closure in total and for each half cycle, and the parts make the whole.
void check_books(const Energy& energy) {
    CAPTURE(energy.closure());
    CHECK(energy.closure() <= promised);
    Work sum;
    for (const HalfCycle& half : energy.half_cycles) {
        CHECK(std::fabs(half.balance.error()) <= promised * energy.flow);
        CHECK(half.balance.work.viscous >= -promised * energy.flow);
        CHECK(half.balance.work.dry >= -promised * energy.flow);
        sum.input += half.balance.work.input;
        sum.viscous += half.balance.work.viscous;
        sum.dry += half.balance.work.dry;
    }
    CHECK(std::fabs(sum.input - energy.total.work.input) <= promised * energy.flow);
    CHECK(std::fabs(sum.viscous - energy.total.work.viscous) <= promised * energy.flow);
    CHECK(std::fabs(sum.dry - energy.total.work.dry) <= promised * energy.flow);
}

}  // namespace

TEST_CASE("the energy of every reference system adds up", "[energy]") {
    for (const ReferenceSystem& s : reference_systems()) {
        CAPTURE(s.name);
        const Energy energy = energy_of_run(s.oscillator, s.excitation, s.initial, s.window);
        CHECK((energy.flow > 0) == (s.name != "start on the limit"));
        check_books(energy);
        // Dry friction is constant, so what it takes is Rd times the way, and the way is told by the exact motion.
        double way = 0;
        const ExactMotion exact = s.exact();
        double theta = s.initial.theta;
        for (const TrueEvent& event : exact.events()) {
            way += std::fabs(static_cast<double>(event.theta) - theta);
            theta = static_cast<double>(event.theta);
        }
        way += std::fabs(static_cast<double>(exact.at(s.window.end).theta) - theta);
        // Event angles of a stiff or long run are right to 1e-11 of its size.
        CHECK(std::fabs(energy.total.work.dry - s.oscillator.kinetic_friction() * way) <=
              1e-10 * (energy.flow + s.oscillator.kinetic_friction() * s.size));
    }
}

TEST_CASE("dry friction takes Rd (X0 + X1) of each half cycle of a free decay, exactly", "[energy]") {
    const double Rd = 0.167;
    const Energy energy = energy_of_run(nondimensional(0, Rd), {}, {0, 2 * pi}, {0, 5});
    REQUIRE(energy.half_cycles.size() == 4);
    // Thrown from the middle with the energy of amplitude 1: X = 0.846..., and 2 Rd less at each turn.
    const double first = std::sqrt(1 + Rd * Rd) - Rd;
    double X = first, lost = Rd * first;
    CHECK(energy.half_cycles[0].balance.work.dry == Approx(lost).epsilon(near));
    for (std::size_t i = 1; i < 4; ++i) {
        CAPTURE(i);
        const HalfCycle& half = energy.half_cycles[i];
        const double next = X - 2 * Rd;
        CHECK(half.t_end - half.t_start == Approx(0.5).epsilon(near));
        CHECK(half.balance.work.dry == Approx(Rd * (X + next)).epsilon(near));
        CHECK(half.balance.change.spring == Approx((next * next - X * X) / 2).epsilon(near));
        CHECK(half.balance.change.kinetic == 0);
        CHECK(std::fabs(half.theta_end) == Approx(std::fabs(next)).epsilon(near));
        lost += Rd * (X + next);
        X = next;
    }
    CHECK(energy.total.work.dry == Approx(lost).epsilon(near));
    CHECK(energy.total.work.input == 0);
    CHECK(energy.total.work.viscous == 0);
    CHECK(energy.start.kinetic == Approx(0.5).epsilon(near));
    CHECK(energy.finish.spring == Approx(0.155151392 * 0.155151392 / 2).epsilon(1e-8));  // the report's nine digits
    CHECK(energy.finish.kinetic == 0);
    // What was there at the start, and what the spring gave back after each turn.
    double gave = 0.5;
    for (std::size_t i = 1; i < 4; ++i) {
        const HalfCycle& half = energy.half_cycles[i];
        const double left = half.theta_start * half.theta_end > 0 ? std::pow(half.theta_end, 2) : 0;
        gave += (std::pow(half.theta_start, 2) - left) / 2;
    }
    CHECK(energy.flow == Approx(gave).epsilon(near));
}

TEST_CASE("the sum over a hundred thousand half cycles has no more rounding than one half cycle", "[long][energy]") {
    // The parts of a panel add up to 1e-15 of what flows in it, by chance in either direction; sums that rounded at
    // each half cycle are off by 2e-13 here.
    const Energy energy = energy_of_run(nondimensional(0.119, 0.418), harmonic(1, 2 * pi), {1, 0}, {0, 5e4});
    REQUIRE(energy.half_cycles.size() > 99990);
    CHECK(energy.closure() <= 1e-14);
}

TEST_CASE("jumps of M, announced or not, cost no energy", "[energy]") {
    const Oscillator system = nondimensional(0.05, 0.2);
    check_books(energy_of_run(system, excitations::made(Square{.amplitude = 1, .period = 0.73}), {0.3, 1}, {0, 50}));
    const auto jumps = [](double t) { return std::fmod(t, 0.73) < 0.365 ? 1.0 : -1.0; };
    check_books(
        energy_of_run(system, excitations::made(Scripted{.function = excitations::probe(jumps)}), {0.3, 1}, {0, 50}));
}

TEST_CASE("the columns are the balance of a run up to each row", "[energy]") {
    for (const char* name : {"W3: one stop per half cycle (fig 24)", "W4: resonance, both frictions (fig 27)",
                             "resonance, no dry friction (fig 19)", "stiff, C = 4000"}) {
        const ReferenceSystem& s = reference_system(name);
        CAPTURE(s.name);
        const double dt = (s.window.end - s.window.start) / 37;
        const Run run = must_run(s, Grid::every(dt), Spectral{});
        const Energy whole = energy_of(run).value();
        const Eigen::MatrixXd columns = energy_columns(run);
        REQUIRE(columns.rows() == run.size());
        REQUIRE(columns.cols() == energy_column_count);
        CHECK(columns(0, 0) == 0);
        CHECK(columns(0, 4) == 0);
        for (const Eigen::Index i : {5, 21, 37}) {
            CAPTURE(i);
            const Energy part = energy_of_run(s.oscillator, s.excitation, s.initial, {s.window.start, run.rows(i, 0)});
            const double off = promised * whole.flow;
            CHECK(std::fabs(columns(i, 0) - part.total.work.input) <= off);
            CHECK(std::fabs(columns(i, 1) - part.finish.kinetic) <= off);
            CHECK(std::fabs(columns(i, 2) - part.finish.spring) <= off);
            CHECK(std::fabs(columns(i, 3) - part.total.work.viscous) <= off);
            CHECK(std::fabs(columns(i, 4) - part.total.work.dry) <= off);
        }
        CHECK(columns.col(5).cwiseAbs().maxCoeff() <= promised * whole.flow);
    }
}

TEST_CASE("a mass that never moves keeps the energy of its spring, and no energy flows", "[energy]") {
    const Energy energy = energy_of_run(nondimensional(0.1, 0.3), harmonic(0.1, 3), {0.1, 0}, {0, 9});
    CHECK(energy.half_cycles.empty());
    CHECK(energy.total.error() == 0);
    CHECK(energy.flow == 0);
    CHECK(energy.closure() == 0);
    CHECK(energy.finish.spring == 0.1 * 0.1 / 2);
}

TEST_CASE("a run continued after its memory for the motion was full states up to which time the energy is known",
          "[energy][resume]") {
    const Oscillator system = nondimensional(0.05, 0);
    const Excitation M = harmonic(1, 5);
    const Limits little{.memory = 100000};
    const auto first = simulate(system, {M, {1, 0}}, {0, 500}, Grid::none(), Spectral{}, {}, little);
    REQUIRE(first);
    const auto all = resume(system, M, *first, 600, Grid::none(), Spectral{}, {}, little);
    REQUIRE(all);
    const double kept = first->course->whole_until();
    CHECK(kept > 5);  // a thousand bytes a panel at most, four in two periods
    CHECK(kept < 500);
    CHECK(first->at(kept));
    CHECK_THAT(first->at(kept + 1).error().sentence, Catch::Contains(fmt::format("kept only up to t = {:.6g}", kept)));
    for (const Run& run : {*first, *all}) {
        const auto energy = energy_of(run);
        REQUIRE_FALSE(energy);
        CHECK_THAT(energy.error().sentence, Catch::Contains(fmt::format("kept only up to t = {:.6g}", kept)));
    }
}

TEST_CASE("a delayed function knows its past although the memory for the motion is full", "[energy][resume]") {
    const Oscillator system = nondimensional(0.05, 0.1);
    const auto delayed = std::make_shared<DelayedController>();
    delayed->by = 0.4;
    delayed->function = written([](double t, const State& y, auto) { return std::sin(5 * t) + 0.3 * y.velocity; });
    const Excitation M = native(Scripted{.function = delayed});
    const auto run = [&](const Limits& limits) {
        const auto first = simulate(system, {M, {1, 0}}, {0, 200}, Grid::none(), Spectral{}, {}, limits);
        REQUIRE(first);
        return *resume(system, M, *first, 210, Grid::none(), Spectral{}, {}, limits);
    };
    const Run full = run({.memory = 100000}), whole = run({});
    CHECK(full.course->whole_until() < 100);
    CHECK(full.state_at_stop.theta == whole.state_at_stop.theta);
    CHECK(full.events.size() == whole.events.size());
}

}  // namespace dinal::energy_test
