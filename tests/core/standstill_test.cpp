// What happens at velocity zero: the class that owns it, alone, and the integrators that use it.
#include "motion/standstill.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/stretches.hpp"
#include "model/laws/asymmetric.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"

namespace dinal::standstill_test {

using namespace dinal::model;
using namespace dinal::motion;
using excitations::made;
using excitations::Probe;
using truth::harmonic;
using truth::must_run;
using truth::nondimensional;
using truth::system_of;

namespace {

constexpr double pi = std::numbers::pi;
using Phase = Standstill::Phase;

/// A standstill without an integrator: k = 1, Rd = 0.1, Re = 0.2.
struct Alone {
    explicit Alone(Excitation excitation = {}, State start = {1, -1}, std::optional<Motion> motion_before = {})
        : M(std::move(excitation)), initial(start), before(motion_before) {}

    Oscillator system = system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2});
    Excitation M;
    State initial;
    std::optional<Motion> before;
    Grid grid = Grid::none();
    Monitor monitor;
    Limits limits;
    std::vector<Event> events;
    Problem problem{system, M, initial, {0, 10}, grid, monitor, limits, before};
    Standstill standstill{problem, &events, 1e-6};
};

Excitation feedback(std::function<double(double, const State&)> f) {
    return made(Scripted{.function = std::make_shared<Probe>(std::move(f)), .feedback = true});
}
double sgn(double x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

std::string kinds(std::span<const Event> events) {
    std::string text;
    for (const Event& event : events) text.append(name(event.kind)) += ' ';
    return text;
}

}  // namespace

TEST_CASE("a mass that arrives sticks, turns, or only touched zero", "[standstill]") {
    Alone a;
    Standstill& s = a.standstill;
    CHECK(s.phase() == Phase::moving);
    CHECK(s.motion() == Motion::backward);
    s.arrive();
    CHECK(s.ask({1, -0.5, 0}));  // the spring pulls forward
    CHECK(s.phase() == Phase::leaving);
    CHECK(kinds(a.events) == "turn ");
    s.go_on();
    CHECK(s.phase() == Phase::moving);
    s.arrive();
    CHECK(s.ask({2, 0.1, 0.9}));  // forward again: no event
    CHECK(kinds(a.events) == "turn ");
    s.go_on();
    s.arrive();
    CHECK(s.ask({3, 0.1, 0.3}));
    CHECK(s.phase() == Phase::stuck);
    CHECK(s.release({4, 0.1, 0.4}, Motion::forward));
    CHECK(kinds(a.events) == "turn stick slip ");
    CHECK_FALSE(s.finish());
    s.go_on();
    s.arrive();
    CHECK(s.ask({5, 0.1, 0}));
    CHECK(s.finish());
    CHECK(kinds(a.events) == "turn stick slip stick ");
}

TEST_CASE("a motion that did not get under way takes back what was told of it", "[standstill]") {
    SECTION("a slip never was") {
        Alone a;
        a.standstill.arrive();
        a.standstill.ask({1, 0.1, 0});
        a.standstill.release({2, 0.1, 0.3}, Motion::forward);
        a.standstill.never_left({2, 0.1, 0.3});
        CHECK(kinds(a.events) == "stick ");
        CHECK(a.standstill.phase() == Phase::held);
        a.standstill.go_on();
        CHECK(a.standstill.phase() == Phase::stuck);
    }
    SECTION("a turn was a stick") {
        Alone a;
        a.standstill.arrive();
        a.standstill.ask({1, -0.5, 0});
        CHECK(kinds(a.events) == "turn ");
        a.standstill.never_left({1, -0.5, 0});
        CHECK(kinds(a.events) == "stick ");
        CHECK(a.standstill.motion() == Motion::stuck);
    }
    SECTION("a touch was a stick") {
        Alone a;
        a.standstill.arrive();
        a.standstill.ask({1, 0.5, 0});  // backward, as before
        CHECK(a.events.empty());
        a.standstill.never_left({1, 0.5, 0});
        CHECK(kinds(a.events) == "stick ");
    }
    SECTION("an older event stays what it was") {
        Alone a;
        a.standstill.arrive();
        a.standstill.ask({1, -0.5, 0});
        a.standstill.go_on();
        a.standstill.arrive();
        a.standstill.ask({2, -0.6, 0});
        a.standstill.never_left({2, -0.6, 0});
        CHECK(kinds(a.events) == "turn stick ");
    }
}

TEST_CASE("nothing is an event at the start, but whether the mass began stuck is known", "[standstill]") {
    Alone inside({}, {0.1, 0});
    CHECK(inside.standstill.phase() == Phase::arrived);
    inside.standstill.ask({0, 0.1, 0});
    CHECK(inside.standstill.began_stuck());
    Alone outside({}, {0.5, 0});
    outside.standstill.ask({0, 0.5, 0});
    CHECK_FALSE(outside.standstill.began_stuck());
    outside.standstill.never_left({0, 0.5, 0});
    CHECK(outside.standstill.began_stuck());
    CHECK((inside.events.empty() && outside.events.empty()));
    Alone moving;
    moving.standstill.arrive();
    moving.standstill.ask({1, 0.1, 0});
    CHECK_FALSE(moving.standstill.began_stuck());
}

TEST_CASE("a run that goes on takes the mass as the part before has left it", "[standstill]") {
    CHECK(Alone({}, {0.1, 0}, Motion::stuck).standstill.phase() == Phase::stuck);
    CHECK(Alone({}, {0.5, 0}, Motion::backward).standstill.phase() == Phase::leaving);
    Alone moving({}, {0.5, -1}, Motion::backward);
    CHECK(moving.standstill.phase() == Phase::moving);
    moving.standstill.arrive();
    moving.standstill.ask({0, 0.1, 0});
    CHECK(kinds(moving.events) == "stick ");  // its start is no start
}

TEST_CASE("standstills without end are noticed, those of a slow motion are not", "[standstill]") {
    const auto count = [](double apart) {
        Alone a;
        double t = 0;
        for (int n = 0; n < 1000; ++n) {
            t += apart;
            a.standstill.arrive();
            if (!a.standstill.ask({t, n % 2 == 0 ? -0.5 : 0.5, 0})) return n;
        }
        return 1000;
    };
    CHECK(count(0.9e-6) == 201);
    CHECK(count(1.1e-6) == 1000);
}

TEST_CASE("a feedback is asked at velocity zero, and a hair beyond it when the mass leaves", "[standstill]") {
    Alone a(feedback([](double, const State& y) { return -0.1 * sgn(y.velocity); }));
    CHECK(a.standstill.M_at_rest(1, 0.5, -0.1) == 0);
    a.standstill.arrive();
    a.standstill.ask({1, 0.5, 0});
    CHECK(a.M.value(1, a.standstill.on_its_way({0.5, 0})) == 0.1);
    CHECK(a.M.value(1, a.standstill.on_its_way({0.5, 0.3})) == 0.1);
    CHECK(a.standstill.on_its_way({0.5, -0.3}).velocity == -0.3);
    CHECK(a.standstill.jumps(1, 0.5));
    CHECK_FALSE(Alone(feedback([](double, const State& y) { return -3 * y.velocity; })).standstill.jumps(1, 0.5));
    Alone of_time(made(Constant{0.7}));
    CHECK(of_time.standstill.M_at_rest(1, 0.5, 0.6) == 0.6);  // what the integrator has, is right
}

TEST_CASE("an M that is nowhere great enough holds for good, each side by its own limit", "[standstill]") {
    Alone a(harmonic(0.15, 1));
    a.standstill.arrive();
    a.standstill.ask({1, 0.01, 0});
    CHECK(a.standstill.for_good({1, 0.01, 0}));
    CHECK(a.standstill.for_good({1, -0.05, 0}));
    CHECK_FALSE(a.standstill.for_good({1, 0.06, 0}));
    CHECK_FALSE(a.standstill.for_good({1, -0.06, 0}));
}

// ---- the integrators

TEST_CASE("a feedback that jumps at velocity zero rests alike in every integrator", "[standstill][spectral][rk4]") {
    // M adds 0.1 to Rd while it moves: half cycles lose 2 (Rd + 0.1), 1.1 -> -0.7 -> 0.3 -> 0.1, at 3 pi, where
    // M = 0 and the spring pulls less than Re.
    const Oscillator system = system_of({.inertia = 1, .stiffness = 1, .kinetic_friction = 0.1, .breakaway = 0.2});
    const Excitation M = feedback([](double, const State& y) { return -0.1 * sgn(y.velocity); });
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.01}, Rk4{0.001}, Rk4{0.0037}}) {
        const auto* rk4 = std::get_if<Rk4>(&integrator);
        // rk4: an event in the middle of a step is found to (w0 h)^4 at worst, three times. spectral: the jump is
        // passed in panels of 1e-13.
        const double near = rk4 != nullptr ? 3 * std::pow(rk4->h, 4) + 1e-12 : 1e-11;
        const Trajectory run = must_run(system, M, {1.1, 0}, {0, 30}, Grid::every(0.1), integrator);
        CAPTURE(integrator.index());
        REQUIRE(kinds(run.events) == "turn turn stick ");
        CHECK(run.outcome == Outcome::stuck_at_end);
        const double X[] = {-0.7, 0.3, 0.1};
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(run.events[i].t == within(pi * static_cast<double>(i + 1), near));
            CHECK(run.events[i].theta == within(X[i], near));
            CHECK(run.events[i].M == 0);  // asked at velocity zero
        }
        CHECK(run.rows(run.size() - 1, 2) == 0);
    }
}

TEST_CASE("a run knows whether it began stuck, whatever came later", "[standstill]") {
    const Oscillator system = nondimensional(0.05, 0.2, 0.3);
    for (const Integrator& integrator : std::vector<Integrator>{Exact{}, Spectral{}, Rk4{0.001}}) {
        CAPTURE(integrator.index());
        const auto began_stuck = [&](const Excitation& M, const State& initial, const Oscillator& s) {
            const Trajectory run = must_run(s, M, initial, {0, 3}, Grid::every(0.1), integrator);
            CHECK(analysis::stretches(run).front().stuck == run.began_stuck);
            return run.began_stuck;
        };
        CHECK(began_stuck({}, {0.1, 0}, system));
        CHECK(began_stuck(made(Step{.amplitude = 1, .at = 1}), {0, 0}, system));
        CHECK_FALSE(began_stuck({}, {1, 0}, system));
        CHECK_FALSE(began_stuck({}, {0, 1}, system));
        CHECK_FALSE(began_stuck({}, {0, 0}, nondimensional(0.05, 0)));
    }
}

}  // namespace dinal::standstill_test
