// A smooth narrow bump: what it is, and that nobody steps over it without a word.
#include <cmath>

#include "support/excitations.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
#include "support/within.hpp"

namespace dinal::gaussian_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::excitations;
using truth::Lot;
using truth::must_run;

namespace {

constexpr double w0 = 2 * pi;

Oscillator oscillator(double Rd, double Re) {
    return Oscillator::make({.inertia = 1, .stiffness = w0 * w0, .kinetic_friction = Rd, .breakaway = Re}).value();
}

std::string refusal(const Excitation& M, const Window& window, const Integrator& integrator) {
    const auto run = simulate(oscillator(0, 0), {M, {}}, window, Grid::none(), integrator);
    return run ? "" : run.error().sentence;
}

}  // namespace

TEST_CASE("a gaussian agrees with its formula, and is exactly 0 far away", "[gaussian]") {
    const Excitation M = made(Gaussian{3, 2, 0.5});
    CHECK(M.value(2) == 3);
    CHECK(M.value(2.5) == near(3 * std::exp(-0.5)));
    CHECK(M.value(0.5) == near(3 * std::exp(-4.5)));
    CHECK(M.value(2 - 1.25) == M.value(2 + 1.25));
    CHECK(M.next_break(-99) == never);
    CHECK(M.most() == 3);
    CHECK(M.constant_from() == within(2 + 39 * 0.5, 1e-12));
    CHECK(M.value(M.constant_from()) == 0);
    CHECK(M.windowed(0, 1e3).constant_from() == M.constant_from());
    CHECK(M.windowed(0, 3).constant_from() == 3);
    // Its time of rest is right also where times are too coarse for its width.
    const double late = 1e9;
    const Excitation narrow = made(Gaussian{3, late, 1e-9});
    CHECK(narrow.value(late) == 3);
    CHECK(narrow.value(narrow.constant_from()) == 0);
}

TEST_CASE("a load that grows from zero moves a mass at rest from its first moment on", "[long][gaussian][spectral]") {
    // From 1e-308 down numbers lose their digits, and no M is smooth there.
    for (const double width : {0.01, 0.06}) {
        const auto bump = probe([width](double t) { return std::exp(-0.5 * std::pow((t - 4.45) / width, 2)); });
        const Run run = must_run(oscillator(0, 0), made(Scripted{.function = bump}).scaled(1e6), {}, {0, 6},
                                 Grid::at({6}), Spectral{});
        REQUIRE(run.outcome == Outcome::reached_end);
        const double swing = 1e6 * width * std::sqrt(2 * pi) / w0 * std::exp(-w0 * w0 * width * width / 2);
        CHECK(run.rows(0, 1) == within(swing * std::sin(w0 * 1.55), 1e-10 * swing));
    }
}

TEST_CASE("an integrator with a fixed step refuses a bump that it would miss, and names a step that is short enough",
          "[gaussian][rk4]") {
    const Excitation M = made(Constant{1}) + made(Gaussian{1, 5, 0.01}) + made(Gaussian{1, 8, 0.002});
    CHECK(refusal(M, {0, 7}, Rk4{0.01}) ==
          "h = 0.01 is too long for the narrow bump of M between t = 4.9 and 5.1: use h <= 0.004995, or "
          "integrator.spectral{}");
    CHECK(refusal(M, {0, 9}, Dinal1989{0.01}).find("between t = 7.98 and 8.02: use h <= 0.000999") !=
          std::string::npos);
    CHECK(refusal(M, {0, 7}, Rk4{0.005}).empty());
    CHECK(!refusal(M, {0, 7}, Rk4{0.00501}).empty());
    CHECK(refusal(M, {0, 4}, Rk4{0.1}).empty());
    CHECK(refusal(M, {6, 7}, Rk4{0.1}).empty());
    CHECK(refusal(M.windowed(0, 4), {0, 9}, Rk4{0.1}).empty());
    CHECK(refusal(M, {0, 9}, Spectral{}).empty());
    // The step that is just allowed sees all of it: the error of the rule that it comes to is exp(-pi^2 / h^2 ...).
    const double swing = 0.01 * std::sqrt(2 * pi) / w0 * std::exp(-w0 * w0 * 1e-4 / 2);
    const Run run = must_run(oscillator(0, 0), made(Gaussian{1, 5, 0.01}), {}, {0, 7.3}, Grid::at({7.3}), Rk4{0.005});
    CHECK(run.rows(0, 1) == within(swing * std::sin(w0 * 2.3), 1e-6 * swing));
}

}  // namespace dinal::gaussian_test
