// What exact alone promises; tests/core/oracle_test.cpp has its motions.

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "model/closed_form.hpp"
#include "model/springs.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
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

TEST_CASE("exact names what it does not accept, and the integrator that accepts it", "[exact]") {
    class Zero : public UserFunction {
        double value(double, const State&) override { return 0; }
    };
    const Oscillator system = nondimensional(0.1, 0.2);
    const auto refusal = [](const Oscillator& s, const Excitation& M) {
        const auto run = simulate(s, {M, {1, 0}}, {0, 1}, Grid::none(), Exact{});
        return run ? std::string() : run.error().sentence;
    };
    const auto made = [](Term term) { return Excitation::make(std::move(term)).value(); };
    const std::string of_M =
        "integrator.exact{} supports only native terms other than chirp and gaussian: use integrator.spectral{}, "
        "which supports every M";
    CHECK(refusal(system, made(Chirp{.from = 0, .to = 1, .duration = 1})) == of_M);
    CHECK(refusal(system, made(Gaussian{.sigma = 1})) == of_M);
    CHECK(refusal(system, made(Scripted{.function = std::make_shared<Zero>()})) == of_M);
    const Oscillator slides = system_of({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.1});
    CHECK(refusal(slides, {}) == "integrator.exact{} needs a spring: use integrator.spectral{} for k = 0");
    const Oscillator duffing =
        system_of({.inertia = 1, .stiffness = 1, .spring = springs::PolynomialSpring{{{3, 0.5}}}});
    CHECK(refusal(duffing, {}) == "integrator.exact{} supports only the spring k theta: use integrator.spectral{}");
    CHECK(std::holds_alternative<Spectral>(integrator_for(duffing, {})));
    CHECK(refusal(system, made(Constant{1})).empty());
    // The default is decided by the same question.
    CHECK(std::holds_alternative<Exact>(integrator_for(system, made(Constant{1}))));
    CHECK(std::holds_alternative<Spectral>(integrator_for(system, made(Gaussian{.sigma = 1}))));
    CHECK(std::holds_alternative<Spectral>(integrator_for(slides, {})));
}

TEST_CASE("along a record of samples exact integrates from line to line, whatever rows are requested",
          "[exact][rows]") {
    for (const double uneven : {0.0, 0.3}) {
        Samples record;
        for (int i = 0; i <= 1500; ++i) {
            const double t = (i + uneven * std::sin(1.7 * i)) / 50;
            record.t.push_back(t);
            record.M.push_back(std::sin(5.1 * t) + 0.4 * std::sin(7.7 * t + 1));
        }
        const std::vector<double> asked(record.t.begin(), record.t.begin() + 1400);
        const Excitation M = Excitation::make(Polyline(std::make_shared<const Samples>(record))).value();
        for (const double friction : {0.0, 0.2, 0.9}) {
            CAPTURE(uneven, friction);
            const Oscillator system = nondimensional(0.02, friction);
            const auto run = [&](const Grid& rows, MethodView method) {
                return must_run(system, M, {0.4, 0.1}, {0, 29}, rows, method);
            };
            const Run rows = run(Grid::every(0.0037), Exact{}), other = run(Grid::every(0.0037), Spectral{});
            CHECK(rows.events.size() > 10);
            CHECK((rows.rows.matrix() - other.rows.matrix()).cwiseAbs().maxCoeff() <= 1e-11);
            // A row is written beside the motion, which does not see it.
            const Run without = run(Grid::none(), Exact{}), at_samples = run(Grid::at(asked), Exact{});
            for (const Run* same : {&without, &at_samples}) {
                REQUIRE(same->events.size() == rows.events.size());
                for (std::size_t i = 0; i < rows.events.size(); ++i) {
                    CHECK(same->events[i].t == rows.events[i].t);
                    CHECK(same->events[i].theta == rows.events[i].theta);
                }
                CHECK(same->state_at_stop.theta == rows.state_at_stop.theta);
            }
            for (Eigen::Index i = 0; i < rows.size(); i += 7) {
                const State there = rows.course->at(rows.rows(i, 0)).value();
                CHECK(std::fabs(there.theta - rows.rows(i, 1)) <= 1e-14);
                CHECK(std::fabs(there.velocity - rows.rows(i, 2)) <= 1e-13);
            }
        }
    }
}

TEST_CASE("a row shortly after an arc given by a Taylor series has its exact angle", "[exact][rows]") {
    // A pulse shorter than 0.3 rad is told by its Taylor series, and the arc after it has a row as long after it.
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const double width = 0.125;
    const Excitation M = Excitation::make(Pulse{.amplitude = 1, .at = 1, .width = width}).value();
    const Run run = must_run(system, M, {1, 0}, {0, 4}, Grid::every(width), Exact{});
    const auto stepped = [](double since) { return since > 0 ? 1 - std::cos(since) : 0; };
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const double t = run.rows(i, 0);
        CAPTURE(t);
        // A few roundings of numbers near 1.
        CHECK(std::fabs(run.rows(i, 1) - (std::cos(t) + stepped(t - 1) - stepped(t - 1 - width))) <= 1e-15);
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

TEST_CASE("along a record the angle does not accumulate rounding errors", "[exact]") {
    // A steady ramp, k theta = M - Rd, of 128 samples a time unit, exact in doubles; no event comes.
    const double w0 = 2 * std::numbers::pi, v = 0.3, Rd = 0.125, length = 1000;
    const Oscillator system =
        Oscillator::make({.inertia = 1 / (w0 * w0), .stiffness = 1, .kinetic_friction = Rd}).value();
    Samples record;
    for (int i = 0; i <= 128 * 1000; ++i) {
        record.t.push_back(i / 128.0);
        record.M.push_back(Rd + v * record.t.back());
    }
    const Excitation M = Excitation::make(Polyline(std::make_shared<const Samples>(record))).value();
    const auto run = simulate(system, {M, {0, v}}, {0, length}, Grid::none(), Exact{});
    REQUIRE(run);
    CHECK(run->events.empty());
    // Pulls of up to 300 are rounded to 2.8e-14, 128000 times, by chance: 1e-13 in theta. So are ways if nothing keeps
    // what they lack, and that is 2.6e-12.
    CHECK(run->state_at_stop.theta == within(v * length, 6e-13));
}

}  // namespace dinal::exact_test
