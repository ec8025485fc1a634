// Words and numbers of run:explain(); the stories of whole motions are in tests/lua/explain_test.lua.
#include "analysis/explain.hpp"

#include <cmath>
#include <numbers>

#include "analysis/recurrence.hpp"
#include "model/excitation.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/systems.hpp"
#include "text/characters.hpp"
#include "text/words.hpp"

namespace dinal::explain_test {

using namespace dinal::analysis;
using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::text;
using namespace dinal::truth;
using Catch::Contains;
using excitations::made;

namespace {

constexpr double pi = std::numbers::pi;

}  // namespace

TEST_CASE("the story of an interrupted run says when it was interrupted", "[explain]") {
    const Oscillator system = nondimensional(0, 0.1);
    const auto run = simulate(system, {harmonic(1, 5), {1, 0}}, {0, 100}, Grid::every(0.01), Spectral{},
                              [](double t) { return t < 10; });
    REQUIRE(run);
    CHECK_THAT(explain(*run, system, harmonic(1, 5), Spectral{}), Contains("The run was interrupted at t = 1"));
}

TEST_CASE("the period of a sum is the shortest that all terms share", "[explain]") {
    const auto sum = harmonic(1, 2 * pi) + harmonic(1, 3 * pi);
    CHECK(period_from(sum, 0) == Approx(2).epsilon(1e-12));
    CHECK(period_from(sum + made(Constant{3}), 0) == Approx(2).epsilon(1e-12));
    CHECK(period_from(harmonic(1, 2 * pi) + harmonic(1, std::sqrt(2.0)), 0) == 0);
    CHECK(period_from(harmonic(1, 2 * pi) + harmonic(1, 2 * pi * (1 + 1e-6)), 0) == 0);  // a beat, however slow
    CHECK(period_from(made(Square{1, 1.5}), 0) == 1.5);
    CHECK(period_from(made(Constant{3}), 0) == 0);
    CHECK(period_from({}, 0) == 0);
    // What is over does not count any more; what is to come does.
    const auto pushed = harmonic(1, 2 * pi) + made(Pulse{1, 5, 0.5});
    CHECK(period_from(pushed, 0) == 0);
    CHECK(period_from(pushed, 6) == 1);
    CHECK(period_from(harmonic(1, 2 * pi).windowed(2, never), 0) == 0);
    CHECK(period_from(harmonic(1, 2 * pi).windowed(2, never), 2) == 1);
    CHECK(period_from(harmonic(1, 2 * pi).windowed(-never, 9), 2) == 0);
    CHECK(period_from(made(Scripted{.function = excitations::probe([](double t) { return t; }), .period = 3}), 0) == 3);
}

TEST_CASE("numbers in the story have only significant digits", "[explain]") {
    CHECK(time_text(1.72366416, 1) == "1.7237");
    CHECK(time_text(999.45017942, 1) == "999.4502");
    CHECK(time_text(0, 1) == "0");
    CHECK(number_text(2.2e-16, 0.2) == "0");
    CHECK(number_text(-0.51284861, 1) == "-0.51285");
    CHECK(against_limit(0.155151392, 0.167) == "0.15515 <= Re = 0.167");
    CHECK(against_limit(0.16699999, 0.167) == "0.16699999 <= Re = 0.167");
    CHECK(against_limit(2.95, 0.167) == "2.95 > Re = 0.167");
    CHECK(against_limit(0.5, 0.5) == "Re = 0.5");
    CHECK(percent(0.00123) == "0.123 %");
    CHECK(against_limit(std::nextafter(0.5, 0), 0.5) == "Re = 0.5 to rounding");
    CHECK(against_limit(5.6e-17, 0.1) == "0 <= Re = 0.1");
    CHECK(counted(1, "stop") == "1 stop");
    CHECK(counted(2, "switch") == "2 switches");
    CHECK(counted(0, "stop") == "0 stops");
    CHECK(percent(0.3495) == "34.9 %");
}

TEST_CASE("lines are not broken within a formula", "[explain]") {
    CHECK(wrapped("").empty());
    CHECK(wrapped("a b") == "a b");
    const std::string seventy(70, 'x');
    CHECK(wrapped(seventy + " a b cdef") == seventy + " a b cdef");
    CHECK(wrapped(seventy + " a b cdefg") == seventy + " a b\ncdefg");
    CHECK(wrapped(seventy + " is theta = 0.155 now") == seventy + " is\ntheta = 0.155 now");
    CHECK(wrapped(seventy + " |M - k theta| <= Re = 1") == seventy + "\n|M - k theta| <= Re = 1");
    CHECK(wrapped(seventy + " and 12345 %") == seventy + " and\n12345 %");
    const std::string ninety(90, 'x');
    CHECK(wrapped(ninety + " y") == ninety + "\ny");
}

}  // namespace dinal::explain_test
