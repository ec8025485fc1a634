// Spectral and exact against an integrator that shares nothing with it, on systems and excitations by lot.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/kinds.hpp"
#include "support/measure.hpp"
#include "support/oracle.hpp"
#include "support/random_case.hpp"

namespace dinal::oracle_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

/// What is asked of both: to be no more wrong than a load would make it that is off by this part of k size.
constexpr double accuracy = 1e-11;
/// A feedback may have corners in theta, which no panel ends at: each passage costs up to some tolerance of the panel.
constexpr double accuracy_with_feedback = 1e-10;
/// The load of the second opinion is off by this part of k size, to see what an error does in this case.
constexpr double nudge = 1e-8;
/// A decision that a nudge could turn is nobody's to judge.
constexpr double too_close = nudge;

constexpr long usual_cases = 60;  // scripts/test lots makes thousands

template <class Events>
std::string told(const Events& events) {
    std::string kinds;
    for (const auto& event : events) kinds.append(name(event.kind)) += ' ';
    return kinds;
}

double distance(const State& y, const truth::Motion& truth, double w0) {
    return std::max(std::fabs(static_cast<double>(y.theta - truth.theta)),
                    std::fabs(static_cast<double>(y.velocity - truth.velocity)) / w0);
}

enum class Verdict { right, ambiguous, beyond_bounds, wrong };
struct Finding {
    Verdict verdict;
    std::string reason = {};
};

Load nudged(const RandomCase& c) {
    Load load = c.load;
    load.torque = [f = c.load.torque, by = nudge * c.system.stiffness() * c.size](
                      real t, real inside, const truth::Motion& y) { return f(t, inside, y) + by; };
    return load;
}

/// Half of the places as rows, the other half by run.at.
Finding compare(const RandomCase& c, MethodView method) {
    const double w0 = c.system.natural_frequency();
    std::vector<double> rows;
    for (std::size_t i = 0; i < c.times.size(); i += 2) rows.push_back(c.times[i]);
    // Whatever happens ends within this many questions, each of sixteen panels.
    const Monitor patience = [asked = 0](double) mutable { return ++asked < 10000; };
    const auto run = simulate(c.system, {c.excitation, c.initial}, c.window, Grid::at(rows), method, patience);
    if (!run) return {Verdict::wrong, run.error().sentence};
    if (run->outcome == Outcome::interrupted) return {Verdict::wrong, "it does not come to an end"};
    if (!run->rows.matrix().allFinite()) return {Verdict::wrong, "a row is not finite"};

    const Oracle oracle(c.system, c.load, c.initial, c.window, c.size, c.times);
    if (oracle.gave_up()) return {Verdict::beyond_bounds};
    const Oracle second(c.system, nudged(c), c.initial, c.window, c.size, c.times, 1e-4L * nudge);
    const auto& events = oracle.events();
    if (oracle.narrowest() < too_close || told(events) != told(second.events())) return {Verdict::ambiguous};

    if (!model::is_whole(run->outcome)) {
        return {Verdict::wrong, fmt::format("{} at t = {:.17g}", sentence(run->outcome), run->t_stop)};
    }
    const double asked = (c.excitation.has_feedback() ? accuracy_with_feedback : accuracy) + c.lost_in_time;
    const auto largest = static_cast<double>(oracle.largest());
    for (std::size_t i = 0; i < std::min(events.size(), run->events.size()); ++i) {
        const Event& event = run->events[i];
        const double moved = std::fabs(static_cast<double>(second.events()[i].t - events[i].t)) / nudge;
        const double late = std::fabs(static_cast<double>(event.t - events[i].t));
        const double allowed = asked * (moved + largest / c.size / (w0 * static_cast<double>(events[i].sharpness))) +
                               1e-15 * std::fabs(event.t) + c.late / w0;
        if (as_stop(event.kind) != events[i].kind || late > allowed) {
            return {
                Verdict::wrong,
                fmt::format("event {}: {} at {:.17g}, but it is a {} at {:.17g}, {:.2e} radians off, allowed {:.2e}", i,
                            name(event.kind), event.t, name(events[i].kind), static_cast<double>(events[i].t),
                            w0 * late, w0 * allowed)};
        }
    }
    if (events.size() != run->events.size()) {
        return {Verdict::wrong, "events " + told(run->events) + "but they are " + told(events)};
    }
    for (std::size_t i = 0; i < c.times.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i / 2);
        const auto at = run->at(c.times[i]);
        if (!at) return {Verdict::wrong, at.error().sentence};
        const State y = i % 2 == 0 ? State{run->rows(row, 1), run->rows(row, 2)} : *at;
        const truth::Motion& nudge_of = second.motions()[i];
        const double moved = distance({static_cast<double>(nudge_of.theta), static_cast<double>(nudge_of.velocity)},
                                      oracle.motions()[i], w0) /
                             nudge;
        const double error = distance(y, oracle.motions()[i], w0);
        if (error > asked * (largest + moved)) {
            return {Verdict::wrong, fmt::format("at t = {:.17g} off by {:.2e} of the size, allowed {:.2e}", c.times[i],
                                                error / c.size, asked * (largest + moved) / c.size)};
        }
    }
    return {Verdict::right};
}

Load load_of(const ReferenceSystem& s) {
    Load load;
    const auto drives = s.drives;
    load.torque = [drives](real t, real inside, const truth::Motion&) {
        const auto next =
            std::find_if(drives.begin() + 1, drives.end(), [&](const Piece& piece) { return piece.from > inside; });
        const truth::Drive& d = (next - 1)->drive;
        return d.level + d.slope * t + d.amplitude * std::sin(d.omega * t + d.phase);
    };
    for (std::size_t i = 1; i < drives.size(); ++i) load.breaks.push_back(static_cast<double>(drives[i].from));
    load.quickest = static_cast<double>(drives.front().drive.omega);
    return load;
}

/// One in `clear` cases may be too close to call.
void compare_cases(RandomCase (*random)(std::uint64_t number), MethodView method, long cases, long clear) {
    const long first = number_from("DINAL_ORACLE_FIRST", 0);
    long ambiguous = 0, beyond_bounds = 0;
    for (long i = first; i < first + cases; ++i) {
        const RandomCase c = random(static_cast<std::uint64_t>(i));
        const Finding finding = compare(c, method);
        ambiguous += finding.verdict == Verdict::ambiguous ? 1 : 0;
        beyond_bounds += finding.verdict == Verdict::beyond_bounds ? 1 : 0;
        if (finding.verdict == Verdict::wrong) {
            FAIL_CHECK("case " << i << " (DINAL_ORACLE_FIRST=" << i << " DINAL_ORACLE_CASES=1): " << finding.reason
                               << "\n"
                               << c.story);
        }
    }
    INFO(ambiguous << " ambiguous, " << beyond_bounds << " beyond all bounds, of " << cases);
    CHECK(clear * ambiguous <= cases + clear);
    CHECK(100 * beyond_bounds <= cases + 100);
}

}  // namespace

TEST_CASE("the oracle itself agrees with every closed form", "[oracle]") {
    for (const ReferenceSystem& s : reference_systems()) {
        CAPTURE(s.name);
        const ExactMotion exact = s.exact();
        std::vector<double> times;
        for (int i = 1; i < 40; ++i) times.push_back(s.window.start + (s.window.end - s.window.start) * i / 40.3);
        const Oracle oracle(s.oscillator, load_of(s), s.initial, s.window, s.size, times);
        REQUIRE_FALSE(oracle.gave_up());
        REQUIRE(told(oracle.events()) == told(exact.events()));
        for (std::size_t i = 0; i < oracle.events().size(); ++i) {
            const double late = std::fabs(static_cast<double>(oracle.events()[i].t - exact.events()[i].t));
            // An overdamped system passes zero slowly.
            CHECK(late * s.oscillator.natural_frequency() <= 1e-12 * std::max(1.0, s.oscillator.damping_ratio()));
        }
        for (std::size_t i = 0; i < times.size(); ++i) {
            const truth::Motion y = exact.at(times[i]);
            const State told_by_closed_form{static_cast<double>(y.theta), static_cast<double>(y.velocity)};
            // A thousand steps of 1e-16; the closed forms lose some digits where damping is nearly critical.
            CHECK(distance(told_by_closed_form, oracle.motions()[i], s.oscillator.natural_frequency()) <=
                  1e-13 * s.size);
        }
    }
}

TEST_CASE("spectral computes the same motion as an independent integrator, for random systems", "[oracle][spectral]") {
    compare_cases(random_case, Spectral{}, number_from("DINAL_ORACLE_CASES", usual_cases), 20);
}

TEST_CASE("exact computes the same motion as an independent integrator, at any damping and near resonance",
          "[oracle][exact]") {
    // A quarter of the systems is nearly critical, and creeps.
    compare_cases(random_case_of_closed_forms, Exact{}, number_from("DINAL_ORACLE_CASES", usual_cases), 10);
}

TEST_CASE("no bump is too narrow for spectral, whether the mass rests or moves", "[oracle][spectral][gaussian][long]") {
    // In so short a time as a bump is long, much is too close to call.
    compare_cases(random_case_of_bumps, Spectral{}, number_from("DINAL_ORACLE_CASES", usual_cases / 4), 6);
}

}  // namespace dinal::oracle_test
