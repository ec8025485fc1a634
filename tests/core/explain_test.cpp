// run:explain(): what the sentences must say, on motions whose story is known.
#include "analysis/explain.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "analysis/recurrence.hpp"
#include "model/excitation.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
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

/// The story as one line, so that a phrase is found wherever lines were broken; how long it is was checked before.
std::string told(const Run& run, const Oscillator& system, const Excitation& M, const Integrator& integrator) {
    std::string text = explain(run, system, M, integrator);
    std::istringstream lines(text);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) CHECK(line.size() < 80);
    CHECK(count <= 25);
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

std::string story(const Oscillator& system, const Excitation& M, const State& initial, const Window& window,
                  const Integrator& integrator = Spectral{}, double dt = 0.01) {
    return told(must_run(system, M, initial, window, Grid::every(dt), integrator), system, M, integrator);
}

Excitation feedback(std::function<double(double, const State&)> f) {
    return made(Scripted{.function = std::make_shared<excitations::Probe>(std::move(f)), .feedback = true});
}

}  // namespace

TEST_CASE("the story of a free decay has half cycles, the law of the extremes, and the reason for the rest",
          "[explain]") {
    for (const Integrator& integrator : {Integrator{Spectral{}}, Integrator{Rk4{0.001}}}) {
        const std::string text = story(nondimensional(0, 0.167), {}, {0, 2 * pi}, {0, 5}, integrator);
        CHECK_THAT(text, Contains("There is no M: the motion is free."));
        CHECK_THAT(text, Contains("It made 4 half cycles with 3 turns and 1 stop"));
        CHECK_THAT(text, Contains("theta = 0.84685 (t = 0.22366), -0.51285 (t = 0.72366), 0.17885 (t = 1.2237)."));
        CHECK_THAT(text, Contains("2 Rd/k = 0.334"));
        CHECK_THAT(text, Contains("It stopped at t = 1.7237 at theta = 0.15515 because |M - k theta| = 0.15515 <= Re = "
                                  "0.167. M is constant from then on, so it stays at rest."));
        CHECK_THAT(text, !Contains("At the end"));
    }
}

TEST_CASE("the story of a free decay states how its extremes shrink", "[explain]") {
    const double q = std::exp(-pi * 0.119 / std::sqrt(1 - 0.119 * 0.119));
    CHECK_THAT(story(nondimensional(0.119, 0), {}, {1, 0}, {0, 5}), Contains("Each extreme is 0.68624 ="));
    CHECK(q == Approx(0.68624).margin(5e-6));
    CHECK_THAT(story(nondimensional(0.119, 0.06), {}, {1, 0}, {0, 5}), Contains("q = exp(-pi zeta/sqrt(1 - zeta^2)) = "
                                                                                "0.68624 and Rd/k = 0.06"));
    CHECK_THAT(story(nondimensional(0, 0), {}, {1, 0}, {0, 5}), Contains("Without damping and friction"));
    CHECK_THAT(story(nondimensional(0, 0), {}, {1, 0}, {0, 5}), Contains("repeats itself every 1 (1 T0)"));
    CHECK_THAT(story(nondimensional(2.387, 0), {}, {0, 6}, {0, 5}), Contains("then creeps"));
    CHECK_THAT(story(nondimensional(2.387, 0), {}, {1, 0}, {0, 5}), Contains("moved in one direction"));
    CHECK_THAT(story(nondimensional(0, 0), {}, {0, 0}, {0, 5}), Contains("It stayed there"));
}

TEST_CASE("the story of a steady motion has its period, amplitude, lag, stops and the time stuck", "[explain]") {
    const Oscillator system = nondimensional(0, 0.836);
    for (const Integrator& integrator : {Integrator{Spectral{}}, Integrator{Rk4{0.001}}}) {
        // From t = n/2 + 0.45017942 to (n + 1)/2 + 0.12493764 it is stuck: 0.34951644 of the time.
        const std::string text = story(system, harmonic(1, 2 * pi), {1, 0}, {0, 20}, integrator);
        CHECK_THAT(text, Contains("the motion is steady: it repeats itself every 1 (the period of M)."));
        CHECK_THAT(text, Contains("The amplitude is 0.12917 about theta = 0."));
        CHECK_THAT(text, Contains("It stops twice in each period and is stuck for 35 % of the time."));
        CHECK_THAT(text,
                   Contains("It stopped at t = 19.4502 at theta = 0.12917 because |M - k theta| = 0.17877 <= Re = "
                            "0.836; it stuck for 0.17476, until this torque exceeded Re and it slipped backward."));
        CHECK_THAT(text, Contains("... 35 more ..."));
        CHECK_THAT(text, Contains("was still stuck when the run ended at t = 20"));
        CHECK_THAT(text, Contains("lags behind that of M by 2.002 rad"));
    }
}

TEST_CASE("the fundamental of Den Hartog's motion lags by 2.4555 rad", "[explain]") {
    const double r = 1.35;
    const Oscillator system = nondimensional(0, 0.5);
    // A function tells no period; the motion does.
    const auto sine = [r](double t) { return std::sin(r * 2 * pi * t); };
    const std::string text =
        story(system, made(Scripted{.function = excitations::probe(sine)}), {1, 0}, {0, 100}, Spectral{}, 0.005);
    CHECK_THAT(text, Contains("every 0.74074 (0.74074 T0)"));
    CHECK_THAT(text, Contains("lags behind that of M by 2.455 rad"));
    CHECK_THAT(text, Contains("It does not stop."));
}

TEST_CASE("the story of a growing motion states how it grows", "[explain]") {
    // pi - 4 gamma a period.
    CHECK_THAT(story(nondimensional(0, 0.167), harmonic(1, 2 * pi), {1, 0}, {0, 10}),
               Contains("The motion grows: amplitudes of") && Contains("periods of M, 2.4736 more each time."));
    const auto pushed = feedback([](double, const State& y) { return 0.1 * y.velocity; });
    CHECK_THAT(story(nondimensional(0, 0), pushed, {1, 0}, {0, 10}),
               Contains("M is a feedback") && Contains("The motion grows") && Contains("times as much each time"));
}

TEST_CASE("a motion that has not become steady is not called steady", "[explain]") {
    // Beats of a lightly damped system: they last 1/(2 pi zeta) = 160 periods.
    const std::string beats = story(nondimensional(0.001, 0), harmonic(1, 2 * pi * 0.93), {0, 0}, {0, 40.7});
    CHECK_THAT(beats, !Contains("is steady"));
    const std::string start = story(nondimensional(0.119, 0.418), harmonic(1, 2 * pi), {1, 0}, {0, 2});
    CHECK_THAT(start, Contains("too short to tell"));
    const std::string settling = story(nondimensional(0.119, 0.418), harmonic(1, 2 * pi), {1, 0}, {0, 7});
    CHECK_THAT(settling, Contains("is settling"));
    // On the way to nothing is no settling.
    CHECK_FALSE(recurrence(must_run(nondimensional(0.001, 0), {}, {1, 0}, {0, 50}, Grid::none(), Spectral{}).events));
    CHECK_FALSE(recurrence(must_run(nondimensional(0, 1e-4), {}, {1, 0}, {0, 50}, Grid::none(), Spectral{}).events));
}

TEST_CASE("the story of stick-slip under a ramp has the advance in each period", "[explain]") {
    const ReferenceSystem& s = reference_system("spring-pulled block");
    const std::string text = story(s.oscillator, s.excitation, s.initial, {0, 10});
    CHECK_THAT(
        text,
        Contains("The mass started at t = 0 from theta = 0 with velocity 0 and stuck there because |M - k theta| = "
                 "0 <= Re = 29.43, until t = 0.73575, when this torque exceeded Re and it slipped forward."));
    CHECK_THAT(text, Contains("It advances by 0.0066769 in each period: stick-slip."));
    CHECK_THAT(text, Contains("It stops once in each period"));
}

TEST_CASE("a slip at a jump of M is explained by the jump", "[explain]") {
    const ReferenceSystem& s = reference_system("pulse on a resting mass at 20 T0");
    const std::string text = story(s.oscillator, s.excitation, s.initial, s.window);
    CHECK_THAT(text, Contains("M is constant from t = 20.125 on."));
    CHECK_THAT(
        text,
        Contains("until t = 20, when M jumped so that |M - k theta| = 2.95 > Re = 0.167, and it slipped forward."));
    CHECK_THAT(text, Contains("stays at rest"));
}

TEST_CASE("the story says why a mass never moved, or cannot move any more", "[explain]") {
    const std::string unmoved = story(nondimensional(0, 0.5), harmonic(0.1, 12), {0.1, 0}, {0, 50});
    CHECK_THAT(unmoved, Contains("Nothing moved it until the end of the run, t = 50."));
    CHECK_THAT(unmoved, Contains("|M| never exceeds 0.1, which is too little to move it: it stays at rest."));
    // 0.3 (cos 2x - cos x) is between -0.34 and 0.6: at 0.4 no harm comes of it, though 0.6 the other way were too
    // much.
    const Excitation waves = Excitation::make(Harmonic{.amplitude = -0.3, .omega = 12, .phase = pi / 2}).value() +
                             Excitation::make(Harmonic{.amplitude = 0.3, .omega = 24, .phase = pi / 2}).value();
    const std::string passed = story(nondimensional(0, 0.8), waves, {0.4, 0}, {0, 50});
    CHECK_THAT(passed, Contains("A whole period of M did not move it, so it stays at rest."));
    const std::string stopped = story(nondimensional(0, 0.5), harmonic(0.1, 12), {3, 0}, {0, 50});
    CHECK_THAT(stopped, Contains("was still stuck when the run ended at t = 50. |M| never exceeds 0.1"));
    CHECK_THAT(stopped, !Contains("steady"));
}

TEST_CASE("the story of a limit cycle under feedback calls it one", "[explain]") {
    const auto van_der_pol =
        feedback([](double, const State& y) { return 0.1 * (1 - y.theta * y.theta) * y.velocity; });
    CHECK_THAT(story(nondimensional(0, 0.05), van_der_pol, {0.5, 0}, {0, 60}), Contains("This is a limit cycle"));
}

TEST_CASE("the story of a failed run says that it failed, and when", "[explain]") {
    const Oscillator system = nondimensional(0, 0.1);
    const auto interrupted = simulate(system, {harmonic(1, 5), {1, 0}}, {0, 100}, Grid::every(0.01), Spectral{},
                                      [](double t) { return t < 10; });
    REQUIRE(interrupted);
    CHECK_THAT(told(*interrupted, system, harmonic(1, 5), Spectral{}), Contains("The run was interrupted at t = 1"));
    const auto fails = made(Scripted{.function = excitations::probe([](double t) {
                                         return t < 3 ? std::sin(t) : std::numeric_limits<double>::quiet_NaN();
                                     })});
    CHECK_THAT(story(system, fails, {1, 0}, {0, 10}), Contains("The run stopped early, at t = 3: M failed"));
    const auto chatter = feedback([](double, const State& y) { return y.velocity == 0 ? 0.5 : -5; });
    CHECK_THAT(story(system, chatter, {0, 0}, {0, 5}),
               Contains("The run stopped early") && Contains("no jump was located"));
}

TEST_CASE("the story of a run that failed before anything moved the mass says that it was stuck", "[explain]") {
    class Failing : public UserFunction {
    public:
        double value(double t, const State&) override { return t > 2 ? std::nan("") : 1.0; }
    };
    const Excitation M = Excitation::make(Scripted{.function = std::make_shared<Failing>()}).value();
    const std::string text = story(nondimensional(0, 0.3), M, {1, 0}, {0, 10});
    CHECK_THAT(text, Contains("stuck there because |M - k theta| = 0 <= Re = 0.3."));
    CHECK_THAT(text, Contains("The run stopped early, at t = 2: M failed"));
    CHECK_THAT(text, !Contains("moved off") && !Contains("in balance"));
}

TEST_CASE("far from t = 0 a load that grows past Re is not taken for a jump", "[explain]") {
    const std::string text = story(nondimensional(0.05, 0.3), harmonic(1, 2 * pi), {1, 0}, {1e9, 1e9 + 2});
    CHECK_THAT(text, Contains("exceeded Re"));
    CHECK_THAT(text, !Contains("jumped"));
}

TEST_CASE("viscous damping alone brings a mass to rest if breakaway friction can hold it", "[explain]") {
    const std::string text = story(nondimensional(0.05, 0, 0.3), {}, {1, 0}, {0, 40});
    CHECK_THAT(text, Contains("until friction holds the"));
    CHECK_THAT(text, !Contains("never quite ends"));
}

TEST_CASE("the story does not depend on dense output, rows, or the size of the units", "[explain]") {
    const Oscillator system = nondimensional(0, 0.836);
    const auto bare =
        simulate(system, {harmonic(1, 2 * pi), {1, 0}}, {0, 1000.2}, Grid::none(), Spectral{}, {}, {.dense = false});
    REQUIRE(bare);
    const std::string text = told(*bare, system, harmonic(1, 2 * pi), Spectral{});
    CHECK_THAT(text, Contains("The amplitude is 0.12917 about theta = 0. It stops twice"));
    CHECK_THAT(text, Contains("It stopped at t = 999.4502 at"));
    for (const char* name : {"W3 with I = 1e-6, k = 1e3, angles of 1e-9", "W3 with I = 1e5, k = 1, angles of 1e6"}) {
        const ReferenceSystem& s = reference_system(name);
        const Run run = must_run(s, Grid::none(), Spectral{});
        CHECK_THAT(told(run, s.oscillator, s.excitation, Spectral{}),
                   Contains("the period of M") && Contains("twice in each period and is stuck for 35 %"));
    }
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
