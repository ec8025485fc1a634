// Random runs of each integrator against one that shares no code with dinal: plain systems under native terms,
// functions of time and feedback, and systems with laws of friction, springs, walls, belts, bases, states, controllers
// and acts.
#include "support/catch.hpp"
#include "support/random_case.hpp"
#include "support/systems.hpp"

namespace dinal::oracle_test {

using namespace dinal::motion;
using namespace dinal::truth;

namespace {

constexpr long usual_cases = 30;  // scripts/test lots makes thousands
constexpr double accuracy = 1e-11;

bool is_exact(const RandomCase& c, std::uint64_t) {
    const model::Oscillator system = system_of(c.parameters);
    return static_cast<bool>(simulate(system, c.drive, {0, 1e-9}, Grid::none(), Exact{}));
}
/// Not each case, as rk4 takes its time.
bool has_steps(const RandomCase& c, std::uint64_t number) {
    return number % 3 == 0 && !c.untold && !c.remembers && !c.corners;
}

}  // namespace

TEST_CASE("spectral computes the same motion as an independent integrator, for random systems", "[oracle][spectral]") {
    check_cases(random_case, {{Spectral{}, accuracy}}, usual_cases, 20);
}

TEST_CASE("exact computes the same motion as an independent integrator, at any damping and near resonance",
          "[oracle][exact]") {
    // A quarter of the systems is nearly critical, and creeps.
    check_cases(random_case_of_closed_forms, {{Exact{}, 1e-12}}, usual_cases, 10);
}

TEST_CASE("no bump is too narrow for spectral, whether the mass rests or moves", "[oracle][spectral][gaussian][long]") {
    // In so short a time as a bump is long, much is too close to call.
    check_cases(random_case_of_bumps, {{Spectral{}, accuracy}}, usual_cases / 4, 6);
}

TEST_CASE("random systems of all kinds agree with an independent integrator, event by event", "[hybrid][mixed]") {
    // rk4: (w h)^4/120 over some ten radians at w = 4, plus the cubics between its steps.
    check_cases(
        random_case_of_all_kinds,
        {{Spectral{}, accuracy}, {Exact{}, accuracy, is_exact}, {Dopri5{1e-12}, 1e-9}, {Rk4{0.002}, 1e-8, has_steps}},
        usual_cases, 5);
}

}  // namespace dinal::oracle_test
