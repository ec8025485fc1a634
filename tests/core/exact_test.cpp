// Exact against spectral, which share the law at velocity zero and nothing else; and what exact alone promises.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "model/closed_form.hpp"
#include "model/springs/polynomial_spring.hpp"
#include "support/catch.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
#include "support/within.hpp"

namespace dinal::exact_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// Both are to agree to this part of the greatest angle, and of what an error of M of this part of k size would do.
constexpr double agreement = 1e-11;
/// What such an error does is seen by one of this size.
constexpr double nudge = 1e-8;

#ifdef __SANITIZE_ADDRESS__
constexpr long usual_cases = 200;
#else
constexpr long usual_cases = 1500;
#endif

/// The events but for what rounding decides: short sticks, as when a load draws the mass on just as it comes down to
/// zero (a velocity of 1e-12 of the greatest lasts 1e-6 T0, and longer where the load fades); and swings without
/// friction of 1e-12 of the greatest angle.
std::vector<Event> clear_events(const Trajectory& run, const RandomCase& c, double largest) {
    std::vector<Event> events;
    const double least = 1e-12 * largest;
    for (const Event& event : run.events) {
        const bool short_stick = !events.empty() && event.kind == EventKind::slip &&
                                 event.t - events.back().t < 1e-3 * c.system.natural_period();
        if (short_stick) {
            events.pop_back();
        } else {
            events.push_back(event);
        }
    }
    if (c.system.breakaway() > 0) return events;
    std::vector<Event> swings;
    for (std::size_t i = 0; i < events.size(); ++i) {
        const double before = i == 0 ? c.initial.theta : events[i - 1].theta;
        const double after = i + 1 == events.size() ? run.state_at_stop.theta : events[i + 1].theta;
        if (std::min(std::fabs(events[i].theta - before), std::fabs(events[i].theta - after)) > least) {
            swings.push_back(events[i]);
        }
    }
    return swings;
}

std::string told(const std::vector<Event>& events) {
    std::string kinds;
    for (const Event& event : events) kinds.append(name(event.kind)) += ' ';
    return kinds;
}

/// A decision between turn and stick that hangs on the digits of M - k theta.
bool too_close(const RandomCase& c, const std::vector<Event>& events) {
    const double Re = c.system.breakaway();
    return std::any_of(events.begin(), events.end(), [&](const Event& event) {
        const double off = std::fabs(event.M - c.system.stiffness() * event.theta) - Re;
        return Re > 0 && event.kind != EventKind::slip && std::fabs(off) < 1e-9 * Re;
    });
}

/// Sticks and rests that are told at different times.
bool ends_apart(const std::vector<Event>& one, const std::vector<Event>& other, const RandomCase& c) {
    for (std::size_t i = 0; i < one.size(); ++i) {
        const bool stops = one[i].kind == EventKind::stick || one[i].kind == EventKind::rest;
        if (stops && std::fabs(one[i].t - other[i].t) > 1e-9 * c.system.natural_period()) return true;
    }
    return false;
}

/// How much less sharp an event is than the turn of a swing as great as the greatest: of a turn by the smaller swing
/// beside it, of a slip by the slope of M.
double bluntness(const RandomCase& c, const std::vector<Event>& events, std::size_t i, double last, double largest) {
    const Event& event = events[i];
    if (event.kind == EventKind::slip) {
        const double hair = 1e-6 / c.system.natural_frequency();
        const double rise = std::fabs(c.excitation.value(event.t + hair) - c.excitation.value(event.t - hair)) / 2e-6;
        return std::max(1.0, c.system.stiffness() * largest / rise);
    }
    const double before = std::fabs(event.theta - (i == 0 ? c.initial.theta : events[i - 1].theta));
    const double after = std::fabs(event.theta - (i + 1 == events.size() ? last : events[i + 1].theta));
    return std::max(1.0, largest / std::min(before, after > 0 ? after : before));
}

struct Comparison {
    std::string wrong = {};
    bool ambiguous = false;
    double worst = 0;  ///< of theta, as a part of what is allowed times the agreement
};

Comparison compare(const RandomCase& c) {
    const double w0 = c.system.natural_frequency();
    const auto run_of = [&](const Excitation& M, MethodView method) {
        return simulate(c.system, M, c.initial, c.window, Grid::at(c.times), method);
    };
    const auto exact = run_of(c.excitation, Exact{}), spectral = run_of(c.excitation, Spectral{});
    if (!exact || !spectral) return {(exact ? spectral : exact).error().sentence};
    const double largest =
        std::max({spectral->rows.col(1).cwiseAbs().maxCoeff(), spectral->rows.col(2).cwiseAbs().maxCoeff() / w0,
                  std::fabs(c.initial.theta), std::fabs(c.initial.velocity) / w0});
    const double push = nudge * c.system.stiffness() * c.size;
    const auto other = run_of(c.excitation + Excitation::make(Constant{push}).value(), Spectral{});
    const auto less = run_of(c.excitation + Excitation::make(Constant{-push}).value(), Spectral{});
    const auto events_of = [&](const auto& run) { return clear_events(*run, c, largest); };
    const auto by_exact = events_of(exact), by_spectral = events_of(spectral), by_other = events_of(other);
    if (told(by_spectral) != told(by_other) || told(by_spectral) != told(events_of(less))) return {.ambiguous = true};
    // The end of a creep is where each of them cannot tell it from rest any more.
    const bool creeps = c.system.damping_ratio() > 0.9 && c.system.breakaway() > 0;
    if (too_close(c, by_exact)) return {.ambiguous = true};
    if (creeps && (exact->outcome != spectral->outcome || told(by_exact) != told(by_spectral) ||
                   ends_apart(by_exact, by_spectral, c))) {
        return {.ambiguous = true};
    }
    if (exact->outcome != spectral->outcome) {
        return {fmt::format("exact {}, spectral {}", sentence(exact->outcome), sentence(spectral->outcome))};
    }
    if (told(by_exact) != told(by_spectral)) return {"exact " + told(by_exact) + "; spectral " + told(by_spectral)};
    for (std::size_t i = 0; i < by_exact.size(); ++i) {
        const double moved = std::fabs(by_other[i].t - by_spectral[i].t) / nudge;
        const double late = std::fabs(by_exact[i].t - by_spectral[i].t);
        // Near critical damping a mass comes down to its place with next to no velocity left.
        const double slow = c.system.damping_ratio() > 0.9 ? 1e3 : 1;
        const double blunt = slow * bluntness(c, by_exact, i, exact->state_at_stop.theta, largest);
        if (late > agreement * (moved + 10 / w0 * blunt) + 1e-15 * std::fabs(by_exact[i].t)) {
            return {fmt::format("{} {} at {:.17g} and {:.17g}: {:.2e} radians", name(by_exact[i].kind), i,
                                by_exact[i].t, by_spectral[i].t, w0 * late)};
        }
    }
    Comparison found;
    for (Eigen::Index i = 0; i < exact->size(); ++i) {
        const double off = std::max(std::fabs(exact->rows(i, 1) - spectral->rows(i, 1)),
                                    std::fabs(exact->rows(i, 2) - spectral->rows(i, 2)) / w0);
        const double moved = std::max(std::fabs(other->rows(i, 1) - spectral->rows(i, 1)),
                                      std::fabs(other->rows(i, 2) - spectral->rows(i, 2)) / w0) /
                             nudge;
        const double late = 1e-15 * std::max(std::fabs(c.window.start), std::fabs(c.window.end)) * w0 * largest;
        const double part = off / (largest + moved + late / agreement);
        if (part > found.worst) found.worst = part;
        if (part > agreement) {
            found.wrong = fmt::format("at t = {:.17g} theta {:.17g} and {:.17g}, off by {:.2e} of what is allowed",
                                      exact->rows(i, 0), exact->rows(i, 1), spectral->rows(i, 1), part / agreement);
            return found;
        }
    }
    return found;
}

}  // namespace

TEST_CASE("exact and spectral tell the same motion and the same events, whatever the lot brings", "[exact][spectral]") {
    const long first = number_from("DINAL_ORACLE_FIRST", 0), count = number_from("DINAL_ORACLE_CASES", usual_cases);
    long ambiguous = 0;
    double worst = 0;
    for (long i = first; i < first + count; ++i) {
        const RandomCase c = random_case_of_closed_forms(static_cast<std::uint64_t>(i));
        const Comparison found = compare(c);
        ambiguous += found.ambiguous ? 1 : 0;
        worst = std::max(worst, found.worst);
        if (!found.wrong.empty()) {
            FAIL_CHECK("case " << i << " (DINAL_ORACLE_FIRST=" << i << " DINAL_ORACLE_CASES=1): " << found.wrong << "\n"
                               << c.story);
        }
    }
    if (std::getenv("DINAL_ORACLE_CASES") != nullptr) WARN("worst " << worst << ", " << ambiguous << " ambiguous");
    CHECK(20 * ambiguous <= count + 20);
}

TEST_CASE("exact says what it does not take, and what takes it", "[exact]") {
    class Zero : public UserFunction {
        double value(double, const State&) override { return 0; }
    };
    const Oscillator system = nondimensional(0.1, 0.2);
    const auto refusal = [](const Oscillator& s, const Excitation& M) {
        const auto run = simulate(s, M, {1, 0}, {0, 1}, Grid::none(), Exact{});
        return run ? std::string() : run.error().sentence;
    };
    const auto made = [](Term term) { return Excitation::make(std::move(term)).value(); };
    const std::string of_M =
        "integrator.exact{} takes an M of native terms other than chirp and gaussian: use "
        "integrator.spectral{}, which takes every M";
    CHECK(refusal(system, made(Chirp{.from = 0, .to = 1, .duration = 1})) == of_M);
    CHECK(refusal(system, made(Gaussian{.sigma = 1})) == of_M);
    CHECK(refusal(system, made(Scripted{.function = std::make_shared<Zero>()})) == of_M);
    const Oscillator slides = system_of({.inertia = 1, .stiffness = 0, .kinetic_friction = 0.1});
    CHECK(refusal(slides, {}) ==
          "integrator.exact{} takes a system with a spring: use integrator.spectral{} for k = 0");
    const Oscillator duffing =
        system_of({.inertia = 1, .stiffness = 1, .spring = springs::PolynomialSpring{{{3, 0.5}}}});
    CHECK(refusal(duffing, {}) ==
          "integrator.exact{} knows no spring but k theta: use integrator.spectral{} for this one");
    CHECK(std::holds_alternative<Spectral>(integrator_for(duffing, {})));
    CHECK(refusal(system, made(Constant{1})).empty());
    // The default is decided by the same question.
    CHECK(std::holds_alternative<Exact>(integrator_for(system, made(Constant{1}))));
    CHECK(std::holds_alternative<Spectral>(integrator_for(system, made(Gaussian{.sigma = 1}))));
    CHECK(std::holds_alternative<Spectral>(integrator_for(slides, {})));
}

TEST_CASE("at resonance and next to it the motion grows as it must, without a digit lost", "[exact]") {
    // From rest, undamped, under sin(w t): theta = (r sin(w0 t) - sin(r w0 t)) / (r^2 - 1), by a sum-to-product form.
    for (const double off : {0.0, 1e-15, 1e-12, 1e-8, 1e-5, -1e-3, 0.01, 0.02}) {
        const double w0 = 2 * std::numbers::pi, omega = w0 * (1 + off);
        const Trajectory run = must_run(nondimensional(0, 0), Excitation::make(Harmonic{.omega = omega}).value(),
                                        {0, 0}, {0, 50}, Grid::every(0.37), Exact{});
        const long double w = std::sqrt(1 / static_cast<long double>(nondimensional(0, 0).inertia())),
                          apart = static_cast<long double>(omega) - w;
        double worst = 0, largest = 0;
        for (Eigen::Index i = 0; i < run.size(); ++i) {
            const long double t = run.rows(i, 0), half = apart * t / 2;
            // sin(omega t) w - omega sin(w t) = w (sin(omega t) - sin(w t)) - apart sin(w t)
            const long double sinc = half == 0 ? 1 : std::sin(half) / half;
            const long double theta =
                (w * std::cos((static_cast<long double>(omega) + w) * t / 2) * t * sinc - std::sin(w * t)) * w /
                -(static_cast<long double>(omega) + w);
            worst = std::max(worst, std::fabs(static_cast<double>(theta - run.rows(i, 1))));
            largest = std::max(largest, std::fabs(run.rows(i, 1)));
        }
        CAPTURE(off);
        CHECK(worst <= 1e-13 * largest);
    }
}

TEST_CASE("where a motion leaves its habit, the first zero is found all the same", "[exact]") {
    // Half swings of nearly the same length, and then, as the second sine comes into another phase, one that is cut in
    // two, or longer: the end of the one before is tried first, and must not be taken for the first zero.
    for (const double second : {1.31, 2.9, 3.07, 5.03}) {
        for (const double friction : {0.0, 0.05, 0.3}) {
            for (const double zeta : {0.0, 0.02, 0.4}) {
                const double w0 = 2 * std::numbers::pi;
                const Excitation M = Excitation::make(Harmonic{.amplitude = 1, .omega = 0.41 * w0}).value() +
                                     Excitation::make(Harmonic{.amplitude = 0.6, .omega = 0.41 * second * w0}).value();
                std::vector<double> times(300);
                for (std::size_t i = 0; i < times.size(); ++i) times[i] = 0.2 * static_cast<double>(i);
                const RandomCase c{.story = fmt::format("second {} friction {} zeta {}", second, friction, zeta),
                                   .system = nondimensional(zeta, friction),
                                   .excitation = M,
                                   .load = {},
                                   .initial = {0.3, 0},
                                   .window = {0, 60},
                                   .size = 1,
                                   .times = std::move(times)};
                const Comparison found = compare(c);
                CAPTURE(c.story);
                CHECK(found.wrong == "");
                CHECK_FALSE(found.ambiguous);
            }
        }
    }
}

TEST_CASE("along a record of samples exact goes from line to line, whatever rows are asked for", "[exact][rows]") {
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
            const Trajectory rows = run(Grid::every(0.0037), Exact{}), other = run(Grid::every(0.0037), Spectral{});
            CHECK(rows.events.size() > 10);
            CHECK((rows.rows.matrix() - other.rows.matrix()).cwiseAbs().maxCoeff() <= 1e-11);
            // A row is written beside the motion, which does not see it.
            const Trajectory without = run(Grid::none(), Exact{}), at_samples = run(Grid::at(asked), Exact{});
            for (const Trajectory* same : {&without, &at_samples}) {
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

TEST_CASE("a row stands where it stands, whatever the arc before it was made of", "[exact][rows]") {
    // A pulse shorter than 0.3 rad is told by its Taylor series, and the arc after it has a row as long after it.
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const double width = 0.125;
    const Excitation M = Excitation::make(Pulse{.amplitude = 1, .at = 1, .width = width}).value();
    const Trajectory run = must_run(system, M, {1, 0}, {0, 4}, Grid::every(width), Exact{});
    const auto stepped = [](double since) { return since > 0 ? 1 - std::cos(since) : 0; };
    for (Eigen::Index i = 0; i < run.size(); ++i) {
        const double t = run.rows(i, 0);
        CAPTURE(t);
        // A few roundings of numbers near 1.
        CHECK(std::fabs(run.rows(i, 1) - (std::cos(t) + stepped(t - 1) - stepped(t - 1 - width))) <= 1e-15);
    }
}

TEST_CASE("who may stop a run is asked often, also where M turns a million times a period", "[exact]") {
    const Oscillator system = Oscillator::make({.inertia = 1, .stiffness = 1}).value();
    const Excitation M = Excitation::make(Harmonic{.amplitude = 1, .omega = 1e6}).value();
    int asked = 0;
    const auto run = simulate(system, M, {1, 0}, {0, 20}, Grid::none(), Exact{}, [&](double) { return ++asked < 4; });
    REQUIRE(run);
    CHECK(run->outcome == Outcome::interrupted);  // 2e7 radians were one arc, between two questions
}

TEST_CASE("along a record the angle does not lose what the sum of its ways rounds off", "[exact]") {
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
    const auto run = simulate(system, M, {0, v}, {0, length}, Grid::none(), Exact{});
    REQUIRE(run);
    CHECK(run->events.empty());
    // Pulls of up to 300 are rounded to 2.8e-14, 128000 times, by chance: 1e-13 in theta. So are ways if nothing keeps
    // what they lack, and that is 2.6e-12.
    CHECK(run->state_at_stop.theta == within(v * length, 6e-13));
}

}  // namespace dinal::exact_test
