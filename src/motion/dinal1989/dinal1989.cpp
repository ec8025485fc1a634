#include "motion/dinal1989/dinal1989.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "model/laws/coulomb.hpp"
#include "motion/checkpoints.hpp"
#include "motion/dinal1989/listing.hpp"
#include "motion/interpolation.hpp"
#include "motion/rows.hpp"

namespace dinal::motion::dinal1989 {

namespace {

/// The motion between two steps, which the program of 1989 did not compute: interpolated, or at rest when frozen.
model::State between(const Dinal& dinal, const Loop& a, const Loop& b, double t) {
    if (b.frozen) return dinal.state(a);
    const double t0 = dinal.time(a);
    return StepInterpolant(dinal.time(b) - t0, dinal.state(a), dinal.acceleration(a), dinal.state(b),
                           dinal.acceleration(b))(t - t0);
}

/// Returns whether the next row falls on this step, so that it shows the listing's own numbers. (The last row, at
/// t_end, may not.)
bool on_step(const RowWriter& rows, double t_start, double h, std::size_t step, std::size_t steps_per_row) {
    if (steps_per_row == 0 || rows.next_row() * steps_per_row != step) return false;
    return std::fabs(rows.next_time() - (t_start + static_cast<double>(step) * h)) < 0.5e-9 * h;
}

/// Returns a step up to which no row is due; if rows and steps do not coincide, not necessarily the last such step.
std::size_t step_before_row(const RowWriter& rows, double t_start, double h, std::size_t steps_per_row) {
    if (rows.next_time() == model::never) return std::numeric_limits<std::size_t>::max();
    const std::size_t row_step = rows.next_row() * steps_per_row;
    if (on_step(rows, t_start, h, row_step, steps_per_row)) return row_step;
    return static_cast<std::size_t>(std::max((rows.next_time() - t_start) / h - 2, 0.0));
}

/// Writes the rows before the step to b; returns false if M is not finite at one of them.
bool rows_between(RowWriter& rows, const Dinal& dinal, const Loop& a, const Loop& b) {
    const double end = dinal.time(b);
    while (rows.next_time() < end) {
        const double t = rows.next_time();
        const model::State y = between(dinal, a, b, t);
        const double M = dinal.excitation().value(t, y);
        if (!std::isfinite(M) || !std::isfinite(y.theta) || !std::isfinite(y.velocity)) return false;
        rows.put(y, M, dinal.friction(a));
    }
    return true;
}

/// Derives an event from the stop rule and the sign of V, at the step that detects it.
void record_event(std::vector<model::Event>& events, const Dinal& dinal, const Loop& a, const Loop& b) {
    std::optional<model::EventKind> kind;
    if (b.frozen != a.frozen) {
        kind = b.frozen ? model::EventKind::stick : model::EventKind::slip;
    } else if (a.V * b.V < 0) {
        kind = model::EventKind::turn;
    }
    if (kind) events.push_back({dinal.time(b), *kind, b.U, dinal.M(b)});
}

model::Outcome not_finite(const Loop& p) {
    return std::isfinite(p.Z) ? model::Outcome::state_not_finite : model::Outcome::excitation_not_finite;
}

bool finite(const Loop& p) {
    return std::isfinite(p.U) && std::isfinite(p.V) && std::isfinite(p.Z);
}

/// The motion between the rows, computed by repeating steps.
class Replay final : public Course {
public:
    Replay(const Problem& problem, const Dinal1989& options, std::size_t steps)
        : Course(problem.system),
          checkpoints(steps),
          excitation_(problem.drive.M()),
          options_(options),
          t_start_(problem.window.start) {}

    [[nodiscard]] text::Expected<model::State> at(double t) const override {
        Dinal dinal(system(), excitation_, options_, t_start_);
        const auto step = static_cast<std::size_t>(std::max((t - t_start_) / options_.h - 1, 0.0));
        Loop a = checkpoints.before(step);
        for (;;) {
            const Loop b = dinal.step(a);
            if (dinal.time(b) > t || !finite(b)) return finite(b) ? between(dinal, a, b, t) : dinal.state(a);
            a = b;
        }
    }

    Checkpoints<Loop> checkpoints;

private:
    model::Excitation excitation_;
    Dinal1989 options_;
    double t_start_;
};

}  // namespace

OwnRule Dinal1989::own_rule() const {
    return {fmt::format(
                "The run was integrated as in 1989, in steps of h = {:.5g}: events are detected at the ends of steps, "
                "and the stop rule of the listing decides what is a stop.",
                h),
            "the listing released it at"};
}

/// Returns an error unless the system has only what the program of 1989 read: I, k, C, Rd, Re and Mc.
std::optional<text::Error> Dinal1989::wrong_for(const model::Oscillator& system,
                                                const model::Excitation& /*excitation*/) const {
    if (!system.has_spring()) {
        return text::Error{.sentence = "integrator.dinal1989 divides by k: for k = 0 use integrator.spectral or rk4",
                           .option = "integrator"};
    }
    if (system.walls()) {
        return text::Error{.sentence = "integrator.dinal1989 does not support walls: use integrator.spectral or rk4",
                           .option = "integrator"};
    }
    if (!system.spring().none()) {
        return text::Error{
            .sentence = "integrator.dinal1989 supports only the spring k theta: use integrator.spectral or rk4",
            .option = "integrator"};
    }
    if (system.friction().none() || system.friction().as<model::laws::Coulomb>() != nullptr) return std::nullopt;
    return text::Error{
        .sentence = "integrator.dinal1989 supports only Coulomb friction, Rd and Re: use integrator.spectral or rk4",
        .option = "integrator"};
}

Run Dinal1989::run(const Problem& problem) const {
    Run run;
    RowWriter rows(problem.system, problem.rows, run);
    // A step that would begin within rounding of the end is omitted.
    const double covering = std::min((problem.window.end - problem.window.start) / h, 1e18);
    const auto steps = static_cast<std::size_t>(std::ceil(covering - 1e-9));
    const auto replay = std::make_shared<Replay>(problem, *this, steps);
    std::vector<model::Event> events;
    Dinal dinal(problem.system, problem.drive.M(), *this, problem.window.start);
    const std::size_t steps_per_row = rows.steps_per_row(h);
    Loop now = dinal.start(problem.drive.start());
    std::size_t block = 0, block_end = 0, sampled = 0;
    while (finite(now)) {
        if (on_step(rows, problem.window.start, h, now.step, steps_per_row))
            rows.put(dinal.state(now), dinal.M(now), dinal.friction(now));
        if (now.step == steps) break;
        if (now.step == block_end) {
            replay->checkpoints.add(now);
            if (problem.monitor && !problem.monitor(dinal.time(now))) {
                run.outcome = model::Outcome::interrupted;
                break;
            }
            block = now.step;
            block_end = std::min(block + Dinal::block_steps, steps);
            sampled = dinal.sample(now, block_end - block);
        }
        const std::size_t i = now.step - block;
        const auto before_row = step_before_row(rows, problem.window.start, h, steps_per_row);
        const std::size_t until = std::min(block + sampled, before_row);
        if (block + i < until && dinal.plain_steps(now, i, until - block) > i) continue;

        const Loop next = i < sampled ? dinal.step(now, i) : dinal.step(now);
        if (finite(next)) {
            const bool row_at_end = on_step(rows, problem.window.start, h, next.step, steps_per_row);
            if (!row_at_end && !rows_between(rows, dinal, now, next)) {
                run.outcome = model::Outcome::excitation_not_finite;
                break;
            }
            record_event(events, dinal, now, next);
        }
        now = next;
    }
    if (!finite(now)) run.outcome = not_finite(now);
    run.t_start = problem.window.start;
    run.t_stop = std::min(dinal.time(now), problem.window.end);
    if (run.outcome == model::Outcome::reached_end) {
        while (rows.next_time() < model::never) rows.put(dinal.state(now), dinal.M(now), dinal.friction(now));
        run.t_stop = problem.window.end;
        if (now.frozen) run.outcome = model::Outcome::stuck_at_end;
    }
    rows.finish();
    if (problem.drive.M().has_script()) run.gap = run.unproven = h / 2;
    run.state_at_stop = dinal.state(now);
    run.motion_at_stop = now.frozen ? model::Motion::stuck : model::motion_of(run.state_at_stop.velocity);
    run.events = Growing<model::Event>(std::move(events));
    if (problem.limits.dense) run.course = replay;
    return run;
}

}  // namespace dinal::motion::dinal1989
