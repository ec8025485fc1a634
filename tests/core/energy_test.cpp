// run:energy() where the memory is full; tests/lua/energy_test.lua has the rest.
#include "analysis/energy.hpp"

#include <fmt/format.h>

#include <cmath>

#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/systems.hpp"
#include "support/written.hpp"

namespace dinal::energy_test {

using namespace dinal::analysis;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

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
