#include "support/random_stops.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "model/laws/asymmetric.hpp"
#include "model/laws/stribeck.hpp"
#include "model/springs/polynomial_spring.hpp"
#include "model/springs/user_spring.hpp"
#include "support/kinds.hpp"
#include "support/measure.hpp"
#include "support/random_case.hpp"
#include "support/stops_truth.hpp"
#include "support/written.hpp"

namespace dinal::truth {

namespace {

using model::Event;
using model::EventKind;

/// The load of the second truth is off by this, to see what an error does in a case.
constexpr double stops_nudge = 1e-8;

struct StopsCase {
    std::string story;
    model::OscillatorParameters parameters;
    model::Excitation M;
    StopsSystem truth;
    model::State initial;
    double t_end = 0;
    std::vector<double> times;
};

void draw_spring(Lot& lot, StopsCase& c) {
    const double k = c.parameters.stiffness;
    switch (lot.of(4)) {
        case 0: {
            const double c3 = lot.between(0.1, 1.5);
            c.parameters.spring = model::springs::PolynomialSpring{{{3, c3}}};
            c.truth.spring = [c3](real x) { return c3 * x * x * x; };
            c.story += fmt::format(" cubic {:.17g}", c3);
            break;
        }
        case 1: {  // a double well, held together by its cubic part
            const double c1 = -k - lot.between(0.1, 0.8), c2 = lot.between(-0.2, 0.2), c3 = lot.between(0.4, 1.2);
            c.parameters.spring = model::springs::PolynomialSpring{{{1, c1}, {2, c2}, {3, c3}}};
            c.truth.spring = [=](real x) { return ((c3 * x + c2) * x + c1) * x; };
            c.story += fmt::format(" well {:.17g} {:.17g} {:.17g}", c1, c2, c3);
            break;
        }
        case 2: {
            const double a = lot.between(0.3, 1.2);
            c.parameters.spring = model::springs::UserSpring{
                written([a](double x, const model::State&, std::span<const double>) { return a * std::sin(x); })};
            c.truth.spring = [a](real x) { return a * std::sin(x); };
            c.story += fmt::format(" pendulum {:.17g}", a);
            break;
        }
        default: {
            const double a = lot.between(0.2, 1);
            c.parameters.spring = model::springs::UserSpring{
                written([a](double x, const model::State&, std::span<const double>) { return a * std::sinh(x); })};
            c.truth.spring = [a](real x) { return a * std::sinh(x); };
            c.story += fmt::format(" progressive {:.17g}", a);
        }
    }
}

void draw_friction(Lot& lot, StopsCase& c) {
    switch (lot.of(4)) {
        case 0:
            return;
        case 1: {
            const model::laws::Coulomb forward{lot.between(0, 0.3), 0.35}, backward{lot.between(0, 0.2), 0.25};
            c.parameters.friction = model::laws::AsymmetricCoulomb{.forward = forward, .backward = backward};
            c.truth.Rd = {backward.kinetic, forward.kinetic};
            c.truth.Re = {backward.breakaway, forward.breakaway};
            c.story += fmt::format(" Rd {:.17g} {:.17g}", backward.kinetic, forward.kinetic);
            return;
        }
        default: {
            const double Rd = lot.between(0.02, 0.3), Re = lot.once_in(2) ? Rd : Rd * lot.between(1, 1.6);
            c.parameters.kinetic_friction = Rd;
            c.parameters.breakaway = Re;
            c.truth.Rd = {Rd, Rd};
            c.truth.Re = {Re, Re};
            c.story += fmt::format(" Rd {:.17g} Re {:.17g}", Rd, Re);
        }
    }
}

void draw_walls(Lot& lot, StopsCase& c) {
    model::Walls walls{-lot.between(0.2, 1.1), lot.between(0.2, 1.1), lot.once_in(4) ? 0 : lot.between(0.2, 0.95)};
    if (lot.once_in(4)) walls.lower = -model::never;
    c.parameters.walls = walls;
    c.truth.walls = TrueWalls{walls.lower, walls.upper, walls.restitution};
    c.initial.theta = lot.between(std::max(walls.lower, -1.0), walls.upper);
    c.story += " walls " + walls.lua_text();
}

StopsCase stops_case(Lots kind, std::uint64_t number) {
    Lot lot(number * 0x2545f4914f6cdd1dU + (kind == Lots::springs ? 7 : 11));
    StopsCase c;
    c.parameters.inertia = lot.between(0.5, 2);
    c.parameters.stiffness = lot.once_in(4) ? 0 : lot.between(0.3, 2);
    if (!lot.once_in(3)) c.parameters.damping = lot.between(0, 0.3);
    c.story = fmt::format("I {:.17g} k {:.17g} C {:.17g}", c.parameters.inertia, c.parameters.stiffness,
                          c.parameters.damping);
    c.truth.I = c.parameters.inertia, c.truth.k = c.parameters.stiffness, c.truth.C = c.parameters.damping;
    if (kind == Lots::springs || lot.once_in(3)) draw_spring(lot, c);
    draw_friction(lot, c);
    const double amplitude = lot.once_in(5) ? 0 : lot.between(0.1, 1.2), omega = lot.between(0.3, 2.5),
                 phase = lot.between(0, 6), level = lot.once_in(2) ? 0 : lot.between(-0.5, 0.5);
    c.M = harmonic(amplitude, omega, phase) + model::Excitation::make(model::Constant{level}).value();
    c.truth.M = [=](real t, const Motion&) -> real {
        return amplitude * std::sin(static_cast<real>(omega) * t + static_cast<real>(phase)) + static_cast<real>(level);
    };
    c.story += fmt::format(" M {:.17g} sin({:.17g} t + {:.17g}) + {:.17g}", amplitude, omega, phase, level);
    c.truth.quickest = std::max(omega, 3.0);
    c.initial = {lot.between(-1, 1), lot.once_in(3) ? 0 : lot.between(-1.2, 1.2)};
    if (kind == Lots::walls) draw_walls(lot, c);
    c.t_end = lot.between(6, 25);
    c.story += fmt::format(" from {:.17g} {:.17g} to {:.17g}", c.initial.theta, c.initial.velocity, c.t_end);
    constexpr int places = 12;
    for (int i = 0; i < places; ++i) c.times.push_back(c.t_end * (i + lot.between(0, 1)) / places);
    return c;
}

/// Impacts slower than this are a detail of how bounces die out.
constexpr double slow_impact = 1e-6;

struct Told {
    EventKind kind;
    double t, theta, velocity;
};
/// Without slow impacts, and without the turns between them.
template <class Events>
std::vector<Told> events_of(const Events& events) {
    std::vector<Told> told;
    bool slow = false;
    for (const auto& e : events) {
        const bool impact = e.kind == EventKind::impact;
        if (impact || e.kind != EventKind::turn) slow = impact && std::fabs(e.velocity) < slow_impact;
        if (slow) continue;
        told.push_back({as_stop(e.kind), static_cast<double>(e.t), static_cast<double>(e.theta),
                        impact ? static_cast<double>(e.velocity) : 0});
    }
    return told;
}
std::string kinds_of(const std::vector<Told>& events) {
    std::string text;
    for (const Told& event : events) text.append(name(event.kind)) += ' ';
    return text;
}

enum class StopsVerdict { right, ambiguous, wrong };

/// `accuracy`: no more wrong than a load would make it that is off by this.
StopsVerdict judge_stops(const StopsCase& c, const motion::Integrator& integrator, double accuracy,
                         const StopsTruth& truth, const StopsTruth& beside, std::string& why) {
    const auto run =
        motion::simulate(system_of(c.parameters), c.M, c.initial, {0, c.t_end}, motion::Grid::at(c.times), integrator);
    if (!run) {
        why = run.error().sentence;
        return StopsVerdict::wrong;
    }
    const auto expected = events_of(truth.events()), shifted = events_of(beside.events()),
               found = events_of(run->events);
    if (kinds_of(expected) != kinds_of(shifted)) return StopsVerdict::ambiguous;
    if (kinds_of(expected) != kinds_of(found)) {
        why = "events " + kinds_of(found) + "but they are " + kinds_of(expected);
        return StopsVerdict::wrong;
    }
    const auto asked = [&](double moved) { return accuracy * (10 + std::fabs(moved) / stops_nudge); };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const Told &e = expected[i], &s = shifted[i], &f = found[i];
        if (std::fabs(f.t - e.t) > asked(s.t - e.t) || std::fabs(f.theta - e.theta) > asked(s.theta - e.theta) ||
            std::fabs(f.velocity - e.velocity) > asked(s.velocity - e.velocity)) {
            why = fmt::format("event {}, {} at {:.15g}: off by {:.2e}, {:.2e}, {:.2e}; allowed {:.2e}", i, name(e.kind),
                              e.t, f.t - e.t, f.theta - e.theta, f.velocity - e.velocity, asked(s.t - e.t));
            return StopsVerdict::wrong;
        }
    }
    for (std::size_t i = 0; i < c.times.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        const Motion &e = truth.motions()[i], &s = beside.motions()[i];
        const double theta = static_cast<double>(e.theta), v = static_cast<double>(e.velocity);
        // A row beside an impact may be on its other side.
        const bool beside_event = std::any_of(expected.begin(), expected.end(),
                                              [&](const Told& told) { return std::fabs(told.t - c.times[i]) < 1e-6; });
        if (beside_event) continue;
        if (std::fabs(run->rows(row, 1) - theta) > asked(static_cast<double>(s.theta) - theta) ||
            std::fabs(run->rows(row, 2) - v) > asked(static_cast<double>(s.velocity) - v)) {
            why =
                fmt::format("at {:.15g}: off by {:.2e}, {:.2e}; allowed {:.2e}", c.times[i], run->rows(row, 1) - theta,
                            run->rows(row, 2) - v, asked(static_cast<double>(s.theta) - theta));
            return StopsVerdict::wrong;
        }
    }
    return StopsVerdict::right;
}

}  // namespace

void check_random_stops(Lots kind, int cases) {
    // As for the oracle: more when somebody has the time, fewer where a sanitizer makes them slow.
    cases = static_cast<int>(number_from("DINAL_ORACLE_CASES", cases));
    int ambiguous = 0, told_of = 0;
    for (int number = 0; number < cases; ++number) {
        const StopsCase c = stops_case(kind, static_cast<std::uint64_t>(number));
        const Motion start{c.initial.theta, c.initial.velocity};
        const StopsTruth truth(c.truth, start, 0, c.t_end, c.times);
        StopsSystem pushed = c.truth;
        pushed.M = [f = c.truth.M](real t, const Motion& y) { return f(t, y) + static_cast<real>(stops_nudge); };
        const StopsTruth beside(pushed, start, 0, c.t_end, c.times, 1e-4L * stops_nudge);
        if (truth.gave_up() || beside.gave_up()) {
            ++ambiguous;
            continue;
        }
        told_of += static_cast<int>(truth.events().size());
        // rk4: (w h)^4/120 of some ten radians at w = 4, and the cubics between its steps.
        for (const auto& [integrator, accuracy] : std::vector<std::pair<motion::Integrator, double>>{
                 {motion::Spectral{}, 1e-11}, {motion::Rk4{0.002}, 1e-8}}) {
            if (accuracy > 1e-9 && number % 6 != 0) continue;  // its many steps take their time
            std::string why;
            const StopsVerdict verdict = judge_stops(c, integrator, accuracy, truth, beside, why);
            ambiguous += verdict == StopsVerdict::ambiguous ? 1 : 0;
            if (verdict == StopsVerdict::wrong) {
                FAIL_CHECK("case " << number << (accuracy < 1e-9 ? ", spectral: " : ", rk4: ") << why << "\n"
                                   << c.story);
            }
        }
    }
    INFO(ambiguous << " ambiguous, " << told_of << " events");
    CHECK(10 * ambiguous <= cases);
    CHECK(told_of > 3 * cases);
}

}  // namespace dinal::truth
