#include "motion/rk4/rk4_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::motion::rk4 {

namespace {

/// The interval up to which successive standstills count as chatter: two steps under feedback, which can stop the mass
/// at every second one.
// NOTE: a step too long for its system may have as many genuine events, so this applies to short steps only.
double at_once(const Problem& problem, double h) {
    constexpr double a_piece = 1.0 / 256;  // fraction of a step, far below the distance of real events
    const bool is_short = h * h * (problem.system.stiffness() / problem.system.inertia()) < 0.01;
    return problem.drive.M().has_feedback() && is_short ? 2 * h : a_piece * h;
}

}  // namespace

Rk4Engine::Rk4Engine(const Problem& problem, const Rk4& options, RowWriter& rows, std::vector<model::Event>* events,
                     Checkpoints<Rk4Checkpoint>* checkpoints)
    : system_(problem.system),
      excitation_(problem.drive.M()),
      monitor_(problem.monitor),
      initial_(problem.drive.start()),
      window_(problem.window),
      rows_(rows),
      checkpoints_(checkpoints),
      block_({problem.system.stiffness() / problem.system.inertia(),
              problem.system.damping() / problem.system.inertia(), options.h},
             problem.system.inertia()),
      steps_(problem.window, options.h),
      steps_per_row_(rows.steps_per_row(options.h)),
      feedback_(problem.drive.M().has_feedback() || system_.has_remainder()),
      contact_(problem, events, at_once(problem, options.h)) {}

model::Outcome Rk4Engine::run() {
    const double t = window_.start;
    const bool at_break = excitation_.next_break(std::nextafter(t, -model::never)) == t;
    const double M = at_break ? excitation_.value_after(t, initial_) : excitation_.value(t, initial_);
    return run({0, initial_, M, contact_.mark()}, steps_.count);
}

model::Outcome Rk4Engine::run(const Rk4Checkpoint& from, std::size_t last_step) {
    begin_at(from);
    std::size_t n = from.step;
    bool alive = finite();
    while (alive && n < last_step) {
        if (checkpoints_ != nullptr && checkpoints_->due(n)) checkpoints_->add(here(n));
        if (monitor_ && !monitor_(t_)) {
            outcome_ = model::Outcome::interrupted;
            break;
        }
        if (contact_.for_good(standstill())) {
            rows_standing_until(model::never);  // nothing can move it again
            t_ = window_.end;
            break;
        }
        const std::size_t stop =
            checkpoints_ != nullptr ? std::min(last_step, std::max(checkpoints_->next(), n + 1)) : last_step;
        const std::size_t count = contact_.phase() == LoneContact::Phase::arrived ? 0 : sample_block(n, stop);
        if (count > 0) {
            alive = run_block(n, count);
            n += count;
        } else {
            alive = careful_step(time(n + 1), nullptr);
            ++n;
        }
    }
    if (outcome_ == model::Outcome::chattering) contact_.forget_chatter();
    if (outcome_ == model::Outcome::reached_end && last_step == steps_.count) {
        stop_at_end();
        rows_standing_until(model::never);
        if (contact_.finish()) outcome_ = model::Outcome::stuck_at_end;
    }
    return outcome_;
}

/// Moves a stop that is beyond the end by no more than the rounding of the time to the end.
void Rk4Engine::stop_at_end() {
    constexpr double few_ulps = 64 * std::numeric_limits<double>::epsilon();
    if (!contact_.stuck() && !contact_.passes() && contact_.phase() != LoneContact::Phase::arrived) {
        const double slower = -model::sign_of(contact_.motion()) * acceleration_at(y_, M_);
        if (std::fabs(y_.velocity) <= slower * few_ulps * std::fabs(t_)) {
            y_.velocity = 0;
            contact_.arrive();
        }
    }
    if (contact_.phase() == LoneContact::Phase::arrived) decide();
}

void Rk4Engine::begin_at(const Rk4Checkpoint& from) {
    t_ = time(from.step);
    y_ = from.state;
    contact_.return_to(from.mark);
    friction_ = system_.braking(contact_.motion());
    M_ = from.M;
}

std::size_t Rk4Engine::sample_block(std::size_t n, std::size_t last_step) {
    if (feedback_) return 0;
    std::size_t count = std::min(engine::AffineBlock::most, last_step - n);
    // The last step may be shorter than h, and ends exactly at t_end.
    if (n + count == steps_.count) --count;
    const double next_break = excitation_.next_break(t_);
    while (count > 0 && time(n + count) >= next_break) count /= 2;
    // It stops before a value that is not finite; the careful step that follows ends the run.
    return block_.sample(excitation_, steps_, n, count);
}

bool Rk4Engine::run_block(std::size_t n, std::size_t count) {
    std::size_t i = 0;
    while (i < count) {
        if (contact_.phase() != LoneContact::Phase::arrived) {
            i = contact_.passes() ? move_freely(n, i, count) : contact_.stuck() ? rest(n, i, count) : move(n, i, count);
            if (!finite()) return false;
        }
        if (i < count) {
            const Loads known{block_.samples[2 * i], block_.samples[2 * i + 1]};
            if (!careful_step(time(n + i + 1), &known)) return false;
            ++i;
        }
    }
    return true;
}

// The plain loops advance from step i of the block at n until something happens, and return the index of that step,
// with the state at its beginning. A step is left to careful_step() if the velocity changes sign in it, or approaches
// zero and recedes, as it may then have crossed zero twice.

std::size_t Rk4Engine::move(std::size_t n, std::size_t i, std::size_t count) {
    block_.begin(i, count, y_, M_, friction_);
    const std::size_t first = i;
    i = block_.step(i, count, model::sign_of(contact_.motion()));
    if (i > first) contact_.note_time_passed();
    end_block(n, first, i);
    return i;
}

std::size_t Rk4Engine::move_freely(std::size_t n, std::size_t i, std::size_t count) {
    block_.begin(i, count, y_, M_, friction_);
    const std::size_t first = i;
    while (i < count) {
        i = block_.step(i, count, model::sign_of(contact_.motion()));
        if (i == count) break;
        // A step in which the velocity changes sign is an ordinary step that records a turn.
        const model::State y = block_.at(i), y1 = block_.end_of(i);
        const double a = acceleration(block_.forcing[i], y), a1 = acceleration(block_.forcing[i + 1], y1);
        record_turns(time(n + i), steps_.h, model::sign_of(contact_.motion()), y, a, y1, a1);
        block_.theta[i + 1] = y1.theta;
        block_.velocity[i + 1] = y1.velocity;
        ++i;
    }
    end_block(n, first, i);
    return i;
}

/// Makes step i the present and writes the rows since step `first`.
void Rk4Engine::end_block(std::size_t n, std::size_t first, std::size_t i) {
    std::size_t good = i;
    while (good > first && !(std::isfinite(block_.theta[good]) && std::isfinite(block_.velocity[good]))) --good;
    block_rows(n, first, good);
    t_ = time(n + i), y_ = {block_.theta[i], block_.velocity[i]}, M_ = block_.M[i];
}

void Rk4Engine::block_rows(std::size_t n, std::size_t first, std::size_t last) {
    const double friction = 0.0 - friction_;
    if (steps_per_row_ == 1 && rows_.next_row() == n + first) {
        rows_.put_block(last - first, &block_.theta[first], &block_.velocity[first], &block_.M[first], friction);
        return;
    }
    for (std::size_t i = first; i < last && rows_.next_time() < model::never; ++i) {
        const double end = time(n + i + 1);
        if (steps_per_row_ != 0) {
            // If rows fall on steps, jump from row to row.
            i = std::max(i, rows_.next_row() * steps_per_row_ - n);
            if (i >= last) return;
            rows_.put({block_.theta[i], block_.velocity[i]}, block_.M[i], friction);
        } else if (rows_.next_time() < end) {
            const model::State y{block_.theta[i], block_.velocity[i]}, y1{block_.theta[i + 1], block_.velocity[i + 1]};
            t_ = time(n + i), y_ = y, M_ = block_.M[i];
            rows_until(end, StepInterpolant(steps_.h, y, acceleration(block_.forcing[i], y), y1,
                                            acceleration(block_.forcing[i + 1], y1)));
        }
    }
}

std::size_t Rk4Engine::rest(std::size_t n, std::size_t i, std::size_t count) {
    engine::Hold hold(contact_.limit(model::Motion::forward), contact_.limit(model::Motion::backward),
                      system_.stiffness() * y_.theta, M_);
    for (; i < count; ++i) {
        if (!hold.lasts(block_.samples[2 * i], block_.samples[2 * i + 1])) break;
        if (rows_.next_time() < time(n + i + 1)) {
            t_ = time(n + i);
            rows_standing_until(time(n + i + 1));
        }
        M_ = block_.samples[2 * i + 1];
    }
    t_ = time(n + i);
    return i;
}

void Rk4Engine::rows_until(double end, const StepInterpolant& motion) {
    while (rows_.next_time() < end && !failed_) {
        const double t = rows_.next_time();
        if (t <= t_) {
            put_row(y_, M_);
        } else {
            const model::State y = motion(t - t_);
            put_row(y, excitation_.value(t, y));
        }
    }
}

void Rk4Engine::rows_standing_until(double end) {
    while (rows_.next_time() < end && !failed_) {
        const double t = rows_.next_time();
        put_row(y_, t <= t_ ? M_ : excitation_.value(t, y_));
    }
}

}  // namespace dinal::motion::rk4
