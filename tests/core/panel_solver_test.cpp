// One panel of the spectral integrator, held alone: no engine, no events, no rows.
#include "motion/spectral/panel_solver.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "model/laws/coulomb.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"
#include "support/reference_systems.hpp"
#include "support/stribeck.hpp"
#include "support/within.hpp"

namespace dinal::panel_solver_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::motion::spectral;
using excitations::made;
using excitations::Probe;
using truth::system_of;
using Attempt = PanelSolver::Attempt;
using End = SolvedPanel::End;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double rounding = 1e-15;  // a few units of numbers of order one

/// k = 1, I = 1, Rd = 0.1, Re = 0.2.
struct Bench {
    explicit Bench(Excitation excitation, const Friction& law = laws::Coulomb{0.1, 0.2})
        : system(system_of({.inertia = 1, .stiffness = 1, .friction = law})), M(std::move(excitation)) {}

    Attempt move(const State& y, Motion way, double t = 0) {
        now = {.clock = {t, 0}, .y = y, .M = M.value(t, y)};
        return solver.move(now, way, y);
    }
    /// As often as it takes.
    Attempt insist(const State& y, Motion way) {
        for (int i = 0; i < 1000; ++i) {
            if (const Attempt attempt = move(y, way); attempt != Attempt::shorten) return attempt;
        }
        return Attempt::shorten;
    }
    [[nodiscard]] const SolvedPanel& panel() const { return solver.panel(); }

    Oscillator system;
    Excitation M;
    Grid grid = Grid::none();
    Monitor monitor;
    Limits limits;
    Problem problem{system, M, {}, {0, 100}, grid, monitor, limits};
    PanelSolver solver{problem, Spectral{}};
    Present now;
};

Excitation feedback(std::function<double(double, const State&)> f, std::vector<double> breaks = {}) {
    return made(
        Scripted{.function = std::make_shared<Probe>(std::move(f)), .feedback = true, .breaks = std::move(breaks)});
}

}  // namespace

TEST_CASE("a panel carries the motion under M, spring and the friction of its way, to rounding", "[panel]") {
    Bench b(made(Constant{0.3}));
    REQUIRE(b.move({1, 0}, Motion::backward) == Attempt::resolved);
    const SolvedPanel& panel = b.panel();
    CHECK(panel.ends == End::inside);
    CHECK(2 * panel.h == within(longest_panel * 2 * pi, 1e-14));
    // About (M + Rd)/k = 0.4, from 0.6 above.
    for (const double x : {-1.0, -0.7, 0.0, 0.3, 1.0}) {
        const double t = panel.time(x);
        CHECK(panel.at(x).theta == within(0.4 + 0.6 * std::cos(t), rounding));
        CHECK(panel.at(x).velocity == within(-0.6 * std::sin(t), rounding));
    }
}

TEST_CASE("a panel ends at an announced break, with M from the left there", "[panel]") {
    const auto past = [](double t, const State& y) { return t < 0.5 ? 0.3 - y.velocity / 8 : 5; };
    for (const Excitation& M : {made(Step{.amplitude = 5, .at = 0.5}), feedback(past, {0.5})}) {
        Bench b(M);
        REQUIRE(b.move({1, 0}, Motion::backward) == Attempt::resolved);
        CHECK(b.panel().ends == End::at_break);
        CHECK(b.panel().end == 0.5);
        CHECK(b.panel().samples.back() < 1);
        CHECK(b.panel().samples.back() == within(chebyshev::value(b.panel().M, 1), rounding));
    }
}

TEST_CASE("the last panel ends with the window, and the two before the end share what remains", "[panel]") {
    Bench b({});
    REQUIRE(b.move({1, 0}, Motion::backward, 99.5) == Attempt::resolved);
    CHECK(b.panel().ends == End::window);
    CHECK(b.panel().end == 100);
    REQUIRE(b.move({1, 0}, Motion::backward, 95) == Attempt::resolved);
    CHECK(b.panel().ends == End::inside);
    CHECK(b.panel().end == 97.5);
}

TEST_CASE("a jump that was not announced is found, and then ends a panel", "[panel]") {
    Bench b(made(Scripted{.function = excitations::probe([](double t) { return t < 0.7 ? 0.1 : 0.9; })}));
    CHECK(b.move({1, 0}, Motion::backward) == Attempt::shorten);
    REQUIRE(b.insist({1, 0}, Motion::backward) == Attempt::resolved);
    CHECK(b.panel().ends == End::at_break);
    CHECK(b.panel().end == 0.7);
    CHECK(b.panel().samples.back() == 0.1);
    // It is behind once the run has passed it.
    b.solver.passed();
    REQUIRE(b.move({0.5, -0.3}, Motion::backward, 0.7) == Attempt::resolved);
    CHECK(b.panel().ends == End::inside);
}

TEST_CASE("an oscillation too quick for a panel makes it shorter, and a calm one longer again", "[panel]") {
    Bench b(made(Harmonic{.amplitude = 1, .omega = 40}));
    CHECK(b.move({1, 0}, Motion::backward) == Attempt::shorten);
    REQUIRE(b.insist({1, 0}, Motion::backward) == Attempt::resolved);
    const double h = b.panel().h;
    CHECK(h * 40 < 8);  // sixteen points to a panel of two or three cycles
    CHECK(h * 40 > 1);
    CHECK(chebyshev::value(b.panel().M, 0.3) == within(std::sin(40 * b.panel().time(0.3)), 1e-11));
}

TEST_CASE("a panel of a mass at rest has M, and asks a feedback for the mass where it stands", "[panel]") {
    Bench b(feedback([](double t, const State& y) { return 0.1 * t - y.theta + 7 * y.velocity; }));
    const State y{0.4, 0};
    REQUIRE(b.solver.stand({.clock = {1, 0}, .y = y, .M = b.M.value(1, y)}) == Attempt::resolved);
    CHECK(b.panel().motion == Motion::stuck);
    for (const double x : {-1.0, 0.2, 1.0}) {
        CHECK(chebyshev::value(b.panel().M, x) == within(0.1 * b.panel().time(x) - 0.4, rounding));
    }
}

TEST_CASE("the motion under feedback and M agree with each other, a stiff spring written as M too", "[panel]") {
    for (const double k : {0.5, 3.0, 400.0}) {
        Bench b(feedback([k](double, const State& y) { return -k * y.theta; }));
        CAPTURE(k);
        REQUIRE(b.insist({1, 0}, Motion::backward) == Attempt::resolved);
        const SolvedPanel& panel = b.panel();
        const double w = std::sqrt(1 + k), rest = 0.1 / (w * w), t = panel.time(0.4);
        CHECK(panel.at(0.4).theta == within(rest + (1 - rest) * std::cos(w * t), 1e-12));
        CHECK(chebyshev::value(panel.M, 0.4) == within(-k * panel.at(0.4).theta, 1e-11 * k));
    }
}

TEST_CASE("friction that depends on speed is in the motion, not in M", "[panel]") {
    Bench b(made(Constant{0.5}), truth::Stribeck{.kinetic = 0.1, .breakaway = 0.3, .speed = 0.2});
    CHECK(b.solver.iterates());
    REQUIRE(b.insist({-1, 0}, Motion::forward) == Attempt::resolved);
    const SolvedPanel& panel = b.panel();
    for (const double x : {-0.9, 0.1, 0.8}) {
        const State y = panel.at(x);
        CHECK(chebyshev::value(panel.M, x) == within(0.5, 1e-12));
        const double acceleration = chebyshev::value(panel.w, x) / (panel.h * panel.h);
        const double friction = 0.1 + 0.2 * std::exp(-std::pow(y.velocity / 0.2, 2));
        CHECK(acceleration == within(0.5 - friction - y.theta, 1e-10));  // twice differentiated: 16^4 roundings
    }
}

TEST_CASE("where M fails, panels end before it, and there the run", "[panel]") {
    const auto M = made(Scripted{.function = excitations::probe([](double t) {
                                     return t < 0.3 ? 0.1 : std::numeric_limits<double>::quiet_NaN();
                                 })});
    Bench b(M);
    REQUIRE(b.insist({1, 0}, Motion::backward) == Attempt::resolved);
    CHECK(b.panel().end < 0.3);
    Bench there(M);
    Attempt attempt = Attempt::shorten;
    for (int i = 0; i < 100 && attempt == Attempt::shorten; ++i) {
        attempt = there.move({1, 0}, Motion::backward, std::nextafter(0.3, 0));
    }
    CHECK(attempt == Attempt::ended);
    CHECK(there.solver.outcome() == Outcome::excitation_not_finite);
}

}  // namespace dinal::panel_solver_test
