// Controllers with a memory, and events of a user, against closed forms.
#include <cmath>

#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/within.hpp"
#include "support/written.hpp"

namespace dinal::controller_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

struct Integrated {
    const char* name;
    Integrator integrator;
};
const Integrated methods[] = {{"spectral", Spectral{}}, {"rk4", Rk4{0.002}}};

}  // namespace

TEST_CASE("a delayed feedback is right by the method of steps", "[hybrid]") {
    // theta'' = -theta(t - 1) with theta = 1 before: polynomials, piece by piece.
    const Oscillator block = Oscillator::make({.inertia = 1, .stiffness = 0}).value();
    auto controller = std::make_shared<DelayedController>();
    controller->by = 1;
    controller->function = written([](double, const State& y, auto) { return -y.theta; });
    const Excitation M = Excitation::make(Scripted{.function = controller, .feedback = true}).value();
    const Trajectory run = run_more(block, M, {1, 0}, 6, 0.25, Spectral{}, {});
    // sum over n of (-1)^n (t - (n - 1))^(2 n)/(2 n)! while t > n - 1
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const long double t = static_cast<long double>(run.rows(i, 0));
        long double theta = 1, sign = -1, factorial = 1;
        for (int n = 1; t > n - 1; ++n, sign = -sign) {
            factorial *= (2 * n - 1) * (2 * n);
            theta += sign * std::pow(t - static_cast<long double>(n - 1), static_cast<long double>(2 * n)) / factorial;
        }
        CHECK(run.rows(i, 1) == within(static_cast<double>(theta), 1e-12));
    }
}

TEST_CASE("a relay switches where its hysteresis says", "[hybrid]") {
    // A block between +-1 with torque -+1: parabolas. From 0 with velocity 1 and torque -1 past off at -0.5 ...
    const Oscillator block = Oscillator::make({.inertia = 1, .stiffness = 0}).value();
    auto controller = std::make_shared<RelayController>();
    controller->on = 0.5, controller->off = -0.5, controller->levels = {-1, 1};
    const Excitation M = Excitation::make(Scripted{.function = controller, .feedback = true}).value();
    for (const Integrated& method : methods) {
        CAPTURE(method.name);
        const Trajectory run = run_more(block, M, {0, 1}, 12, 0.1, method.integrator, {});
        std::vector<Event> switches;
        for (const Event& event : run.events) {
            if (event.kind == EventKind::switched) switches.push_back(event);
        }
        // theta = t - t^2/2 = -0.5 at 1 + sqrt 2, with velocity -sqrt 2; then up again: 0.5 at sqrt 2 + 2 later.
        const double first = 1 + std::sqrt(2.0);
        const double v = -std::sqrt(2.0), second = first - v + std::sqrt(v * v + 2);
        REQUIRE(switches.size() >= 2);
        CHECK(switches[0].t == within(first, 1e-12));
        CHECK(switches[0].theta == within(-0.5, 1e-12));
        CHECK(switches[0].M == 1);
        CHECK(switches[1].t == within(second, 1e-12));
        CHECK(switches[1].M == -1);
    }
}

TEST_CASE("events of a user are located to rounding, each once, and may act or stop", "[hybrid]") {
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    Extras extras;
    const auto level = [](double theta) {
        return written([=](double, const State& y, auto) { return y.theta - theta; });
    };
    extras.events.push_back({.name = "up", .when = level(0.3), .direction = Crossing::up});
    extras.events.push_back({.name = "both", .when = level(0.999)});
    extras.events.push_back({.name = "late",
                             .when = written([](double t, const State&, auto) { return t - 20; }),
                             .direction = Crossing::both,
                             .stop = true});
    const Trajectory run = run_more(system, {}, {0, 1}, 30, 0.5, Spectral{}, extras);  // theta = sin t
    CHECK(run.outcome == Outcome::stopped);
    CHECK(run.t_stop == within(20, 1e-13));
    std::vector<double> up, both;
    for (const Event& event : run.events) {
        if (event.user == 0) up.push_back(event.t);
        if (event.user == 1) both.push_back(event.t);
    }
    const double pi = std::acos(-1.0);
    REQUIRE(up.size() == 4);
    REQUIRE(both.size() == 6);
    for (std::size_t i = 0; i < up.size(); ++i) {
        const double turns = 2 * pi * static_cast<double>(i);
        CHECK(up[i] == within(turns + std::asin(0.3), 1e-12));
        if (i == 3) break;
        CHECK(both[2 * i] == within(turns + std::asin(0.999), 1e-11));
        CHECK(both[2 * i + 1] == within(turns + pi - std::asin(0.999), 1e-11));
    }
    CHECK(run.events.back().user == 2);
}

}  // namespace dinal::controller_test
