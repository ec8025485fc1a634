// Properties of exact alone; tests/core/oracle_test.cpp and tests/lua/scales_test.lua have its motions.
#include "model/closed_form.hpp"
#include "support/catch.hpp"
#include "support/systems.hpp"
#include "support/within.hpp"

namespace dinal::exact_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

TEST_CASE("the slope and the bend of a closed form are its derivatives", "[exact]") {
    const auto made = [](Term term) { return Excitation::make(std::move(term)).value(); };
    for (const Excitation& M : {made(Exponential{2, 0.8, 0.1}), made(Polynomial{{0.5, -0.4, 0.3, 2}, 0.2}),
                                harmonic(1.5, 3), made(Harmonic{.amplitude = 2, .omega = 1.7, .phase = 0.4})}) {
        ClosedForm sum;
        closed_form(M, 0.7, 0, sum);
        constexpr double h = 1e-4;
        CHECK(sum.slope() == within((sum.value(h) - sum.value(-h)) / (2 * h), 1e-6));
        CHECK(sum.bend() == within((sum.value(h) - 2 * sum.value() + sum.value(-h)) / (h * h), 1e-5));
    }
}

TEST_CASE("a monitor can often stop a run, even if M oscillates a million times in a period", "[exact]") {
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const Excitation M = Excitation::make(Harmonic{.amplitude = 1, .omega = 1e6}).value();
    int asked = 0;
    const auto run = simulate(system, {M, {1, 0}}, {0, 20}, Grid::none(), Exact{}, [&](double) { return ++asked < 4; });
    REQUIRE(run);
    CHECK(run->outcome == Outcome::interrupted);  // 2e7 radians were one arc, between two questions
}

}  // namespace dinal::exact_test
