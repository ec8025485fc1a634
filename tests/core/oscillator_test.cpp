// Numbers that cannot come from Lua are refused, too; tests/lua/system_test.lua has the rest.
#include "model/oscillator.hpp"

#include <limits>
#include <string>

#include "model/laws/coulomb.hpp"
#include "model/laws/stribeck.hpp"
#include "model/springs.hpp"
#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"

namespace dinal::oscillator_test {

using namespace dinal::model;

namespace {

using Catch::Matchers::Contains;

std::string complaint(const OscillatorParameters& parameters) {
    const auto system = Oscillator::make(parameters);
    return system ? "" : system.error().sentence;
}

}  // namespace

TEST_CASE("numbers that only a program in C++ can give are refused, too", "[oscillator]") {
    constexpr double inf = std::numeric_limits<double>::infinity();
    const std::pair<OscillatorParameters, const char*> systems[] = {
        {{.inertia = -1, .stiffness = 1}, "I = -1 must be positive"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Coulomb{inf, inf}}, "Rd = inf must be a finite number"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Coulomb{-1, 1}}, "Rd = -1 must not be negative"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::AsymmetricCoulomb{{-1, 1}, {1, 1}}}, "forward.Rd = -1"},
        {{.inertia = 1, .stiffness = 1, .friction = laws::Stribeck{.kinetic = 1, .breakaway = 2}}, "speed = 0 must"},
        {{.inertia = 1, .stiffness = 1, .spring = springs::PolynomialSpring{{{3, inf}}}}, "[3] = inf must be a finite"},
        {{.inertia = 1, .stiffness = 1, .walls = Walls{.lower = -1, .restitution = 2}},
         "restitution = 2 must be from 0 to 1"},
    };
    for (const auto& [parameters, sentence] : systems) CHECK_THAT(complaint(parameters), Contains(sentence));

    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const auto refused = [&](State start, motion::Window window, const motion::Grid& rows) {
        const auto run = motion::simulate(system, {{}, start}, window, rows, motion::Exact{});
        return run ? "" : run.error().sentence;
    };
    const auto none = motion::Grid::none();
    CHECK_THAT(refused({inf, 0}, {0, 1}, none), Contains("theta0 = inf must be a finite number"));
    CHECK_THAT(refused({0, inf}, {0, 1}, none), Contains("velocity0 = inf must be a finite number"));
    CHECK_THAT(refused({}, {-inf, 1}, none), Contains("t_start = -inf must be a finite number"));
    CHECK_THAT(refused({}, {0, inf}, none), Contains("t_end = inf must be a finite number"));
    CHECK_THAT(refused({}, {0, 1}, motion::Grid::every(0)), Contains("dt = 0 must be positive"));
    CHECK_THAT(refused({}, {0, 1}, motion::Grid::at({0, inf})), Contains("times[2] = inf must be a finite number"));
}

}  // namespace dinal::oscillator_test
