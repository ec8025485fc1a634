// Users' functions are asked again: who remembers something is found out, who does not is never accused.
#include "motion/witness.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "motion/integrators.hpp"
#include "motion/simulate.hpp"
#include "support/catch.hpp"
#include "support/excitations.hpp"

namespace dinal::witness_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::excitations;

namespace {

Oscillator swinging() {
    return Oscillator::make({.inertia = 1, .stiffness = 40, .damping = 0.3, .kinetic_friction = 0.2}).value();
}

Trajectory run(const Excitation& M, const Integrator& integrator, double t_end = 20) {
    auto result = simulate(swinging(), M, {1, 0}, {0, t_end}, Grid::every(0.1), integrator);
    if (!result) FAIL(result.error().sentence);
    return std::move(result).value();
}

Excitation with_motion(std::function<double(double, const State&)> f) {
    return made(Scripted{.function = std::make_shared<Probe>(std::move(f)), .feedback = true});
}

/// Deterministic bits of a time: noise that is a function.
double hashed(double t) {
    auto x = std::bit_cast<std::uint64_t>(t) * 0x9E3779B97F4A7C15U;
    x ^= x >> 29U;
    x *= 0xBF58476D1CE4E5B9U;
    return static_cast<double>(x >> 11U) * 0x1p-53;
}

}  // namespace

TEST_CASE("a value is compared bit by bit, and told with its time", "[witness]") {
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.01}}) {
        auto calls = std::make_shared<int>(0);
        const Trajectory found =
            run(made(Scripted{.function = probe([calls](double t) { return std::sin(t) * (1 + 0x1p-50 * ++*calls); })}),
                integrator);
        CHECK(found.outcome == Outcome::not_a_function);
        REQUIRE(found.contradiction);
        CHECK(found.contradiction->who == "M");
        CHECK(found.contradiction->first != found.contradiction->again);
        CHECK(found.contradiction->at >= 0);
        CHECK(found.contradiction->at <= 20);
        CHECK(found.t_stop < 20);
    }
}

TEST_CASE("a switch with a memory is found out at its first switch", "[witness]") {
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.002}}) {
        for (const double threshold : {0.0, 0.05, 0.3, 0.8}) {
            auto on = std::make_shared<bool>(true);
            auto first = std::make_shared<double>(never);
            const Excitation M = with_motion([=](double t, const State& y) {
                const bool before = *on;
                if (y.theta > threshold + 0.05) *on = false;
                if (y.theta < threshold - 0.05) *on = true;
                if (before != *on && t > 0.1) *first = std::min(*first, t);
                return *on ? 20 : -20;
            });
            const Trajectory found = run(M, integrator);
            CAPTURE(threshold, *first);
            CHECK(found.outcome == Outcome::not_a_function);
            CHECK(found.t_stop < *first + 1);
        }
    }
}

TEST_CASE("a value that chance gave once is asked again, also while the mass stands", "[witness]") {
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{}, Rk4{0.01}}) {
        for (const int when : {100, 511, 700, 1200}) {
            auto calls = std::make_shared<int>(0);
            const Excitation M =
                made(Scripted{.function = probe([=](double) { return ++*calls == when ? 0.3 : 0.0; })});
            const Oscillator system =
                Oscillator::make({.inertia = 1, .stiffness = 40, .kinetic_friction = 0.2}).value();
            const auto found = simulate(system, M, {}, {0, 50}, Grid::none(), integrator);
            REQUIRE(found);
            CAPTURE(when);
            CHECK(found->outcome == Outcome::not_a_function);
        }
    }
}

TEST_CASE("noise that is a function of its arguments is not accused, whatever its bits", "[witness]") {
    for (const Integrator& integrator : std::vector<Integrator>{Spectral{.tolerance = 0.1}, Rk4{0.01}}) {
        CHECK(run(made(Scripted{.function = probe(hashed)}), integrator).outcome != Outcome::not_a_function);
        CHECK(run(with_motion([](double t, const State& y) { return hashed(t + y.theta); }), integrator, 2).outcome !=
              Outcome::not_a_function);
    }
}

TEST_CASE("a function that fails when it is asked again has failed, and is not accused", "[witness]") {
    auto calls = std::make_shared<int>(0);
    const Excitation M =
        made(Scripted{.function = probe([calls](double t) {
                          return ++*calls > 100 ? std::numeric_limits<double>::quiet_NaN() : std::sin(t);
                      })});
    CHECK(run(M, Rk4{0.01}).outcome == Outcome::excitation_not_finite);
}

TEST_CASE("a witness asks at most three questions of a hundred again", "[witness]") {
    const Oscillator system = swinging();
    const Grid grid = Grid::every(0.1).within({0, 100}).value();
    for (const auto f :
         {+[](double t) { return std::sin(t); }, +[](double t) { return std::fmod(t, 1) < 0.5 ? 1.0 : -1.0; }}) {
        const auto alone = probe(f), heard = probe(f);
        const Excitation M = made(Scripted{.function = alone});
        CHECK(is_whole(Rk4{0.005}.run({system, M, {1, 0}, {0, 100}, grid, {}, {}}).outcome));
        run(made(Scripted{.function = heard}), Rk4{0.005}, 100);
        CHECK(heard->calls > alone->calls);
        CHECK(heard->calls <= 1.03 * alone->calls);
    }
}

}  // namespace dinal::witness_test
