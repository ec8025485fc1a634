// Every integrator against every reference system: one row for each integrator, with the reason for its tolerance.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"
#include "support/kinds.hpp"
#include "support/measure.hpp"

namespace dinal::conformance_test {

using namespace dinal::model;
using namespace dinal::motion;
using namespace dinal::truth;

namespace {

Grid generic_grid(const ReferenceSystem& s) {
    return Grid::every(s.oscillator.natural_period() / 37.7);
}

/// 1000 or 250 steps to a natural period; for the stiff system so many more that its fast mode is resolved, too.
double step_of(const ReferenceSystem& s, double steps_per_period) {
    const double refined = std::max(1.0, s.fastest_rate() / s.oscillator.natural_frequency() / 20);
    return s.oscillator.natural_period() / steps_per_period / refined;
}

/// The swing and the load, in rad per time unit.
double swing_of(const ReferenceSystem& s) {
    double swing = s.oscillator.natural_frequency();
    for (const Piece& piece : s.drives) swing = std::max(swing, static_cast<double>(piece.drive.omega));
    return swing;
}

/// A step of a method of order p makes a relative error of z^(p+1)/(p+1)! for z = rate h, which the swing and the load
/// add up over `radians`, while a fast mode that dies away hands its error on once. Twice that leaves room for the
/// events, which are located to the same order, and for transients above `size`.
double runge_kutta_tolerance(const ReferenceSystem& s, double h, int order) {
    const double once = s.radians() * std::pow(swing_of(s) * h, order) + 2 * std::pow(s.fastest_rate() * h, order);
    const double truncation = once / std::tgamma(order + 2);
    const double rounding = 1e-15 * (s.window.end - s.window.start) / h + 1e-14;
    return s.size * (2 * truncation + rounding);
}

/// What an integrator is measured with: its options, what its error may be, and what it cannot follow.
struct Row {
    std::vector<Integrator> methods;
    double tolerance;
    bool follows = true, tells_events = true;
};

/// What each panel leaves out is less than 1e-13 of it, and a rounding or two are added with each: some 2 panels of
/// three radians. Times are known to half a unit of the last place of t_end, which shifts a load by as much.
/// Under feedback each panel is iterated until its change is 16 roundings: some two panels a radian leave that.
Row of_spectral(const ReferenceSystem& s) {
    const double iterated = s.same_as ? 2 * 16 * 2.2e-16 * s.radians() : 0;
    return {{Spectral{}}, s.size * (1e-13 + 2e-16 * s.radians() + iterated)};
}

/// Closed forms from event to event: each arc adds a rounding or two, and times are known to half a unit of the last
/// place of t_end, which shifts a load by as much. It takes no feedback, and says so.
Row of_exact(const ReferenceSystem& s) {
    return {{Exact{}}, s.size * (1e-13 + 1e-16 * s.radians()), !s.same_as};
}

Row of_rk4(const ReferenceSystem& s, double h) {
    return {{Rk4{h}}, runge_kutta_tolerance(s, h, 4)};
}

/// The estimate is that of the method of order 4. The step is of order 5, and better by about the angle of the motion
/// that it takes: so its error is less than the tolerance in each radian.
Row of_dopri5(const ReferenceSystem& s, double tolerance) {
    return {{Dopri5{tolerance}}, s.size * (2 * tolerance * s.radians() + 1e-13)};
}

/// The listing looks for zeros of the velocity between whole steps only and its sign changes within a stage: each
/// passage is noticed up to a step late, while up to Rd + Re pushes the wrong way: w0 h (Rd + Re)/k in velocity/w0.
/// A mass held by the rule keeps a stale velocity of the same size. Dry friction forgets old errors, so that a few
/// such errors at once are the most to be seen.
/// The rule of 1989 keeps comparing the stale velocity with what a step would make of it. That holds the mass only
/// while friction Rd outweighs the load: with Re > Rd it lets go at Rd, and no step cures that (dinal1989_test.cpp).
/// Its own rule tells its events, late, and a feedback jumps at the very zero that it looks for between steps.
Row of_dinal1989(const ReferenceSystem& s, const ExactMotion& exact, double h) {
    const Oscillator& o = s.law();
    const double once = o.natural_frequency() * h * (o.kinetic_friction() + o.breakaway()) / o.stiffness();
    const bool slips = exact.count(EventKind::slip) > 0;
    return {{Dinal1989{.h = h, .stop = Dinal1989::Stop::listing}, Dinal1989{.h = h, .stop = Dinal1989::Stop::text}},
            runge_kutta_tolerance(s, h, 4) + 3 * once,
            !s.same_as && (o.breakaway() <= o.kinetic_friction() || !slips),
            false};
}

std::vector<Row> rows_for(const ReferenceSystem& s, const ExactMotion& exact) {
    std::vector<Row> rows{of_spectral(s), of_exact(s)};
    for (const double steps : {1000.0, 250.0}) {
        rows.push_back(of_rk4(s, step_of(s, steps)));
        rows.push_back(of_dinal1989(s, exact, step_of(s, steps)));
    }
    for (const double tolerance : {1e-6, 1e-11}) rows.push_back(of_dopri5(s, tolerance));
    return rows;
}

void check_events(const ReferenceSystem& s, const Run& run, const ExactMotion& exact, double tolerance) {
    const auto& expected = exact.events();
    std::string told;
    std::string wanted;
    for (const Event& event : run.events) told.append(name(as_stop(event.kind))) += ' ';
    for (const TrueEvent& event : expected) wanted.append(name(event.kind)) += ' ';
    REQUIRE(told == wanted);
    // At an event the velocity is 0 and theta stationary; a release follows M alone. The time of a zero is the error
    // of the velocity over the acceleration, which is a good part of w0^2 size in all systems of the list but for the
    // overdamped ones: hence the factor.
    const double slowness = std::max(1.0, s.oscillator.damping_ratio());
    const double time_tolerance = 100 * slowness * tolerance / s.size / s.oscillator.natural_frequency();
    for (std::size_t i = 0; i < expected.size(); ++i) {
        CAPTURE(i, name(expected[i].kind));
        CHECK(std::fabs(static_cast<double>(run.events[i].t - expected[i].t)) <= time_tolerance);
        CHECK(std::fabs(static_cast<double>(run.events[i].theta - expected[i].theta)) <= tolerance);
    }
    CHECK((run.outcome == Outcome::at_rest || run.outcome == Outcome::stuck_at_end) == exact.ends_stuck());
}

std::vector<ReferenceSystem> all_systems() {
    std::vector<ReferenceSystem> all = reference_systems();
    const auto& jumping = jumping_feedback_systems();
    all.insert(all.end(), jumping.begin(), jumping.end());
    return all;
}

}  // namespace

TEST_CASE("each integrator follows every reference system, with its events in kind and order", "[conformance]") {
    for (const ReferenceSystem& s : all_systems()) {
        const ExactMotion exact = s.exact();
        for (const Row& row : rows_for(s, exact)) {
            for (const Integrator& method : row.methods) {
                if (!row.follows) continue;
                CAPTURE(s.name, MethodView(method).lua_text(text::Defaults::left_out));
                const Run run = must_run(s, generic_grid(s), method);
                const double error = error_of(run, exact, s.oscillator);
                INFO(fmt::format("error {:.2e}, tolerance {:.2e}", error, row.tolerance));
                CHECK(error <= row.tolerance);
                if (row.tells_events) check_events(s, run, exact, row.tolerance);
            }
        }
    }
}

}  // namespace dinal::conformance_test
