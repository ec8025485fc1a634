// run:energy() of every reference system, and where the memory is full; tests/lua/energy_test.lua has the rest.
#include "analysis/energy.hpp"

#include <fmt/format.h>

#include <cmath>

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

/// The promise: nothing that flowed is lost but this part. What is found is near 1e-15, the rounding of a panel.
constexpr double promised = 1e-12;

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

TEST_CASE("a run continued after its memory was full states up to which time its energy is known", "[energy][resume]") {
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
