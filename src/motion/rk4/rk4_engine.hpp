// Runge-Kutta through dry friction: blocks of plain steps while nothing happens, single careful steps around events.
// Steps lie on the grid t_start + n h; events and breaks of M cut a step into pieces. Requested rows never do, so they
// do not change the motion.
#pragma once

#include <vector>

#include "motion/engine/affine_block.hpp"
#include "motion/interpolation.hpp"
#include "motion/lone_contact.hpp"
#include "motion/rk4/rk4.hpp"
#include "motion/rows.hpp"

namespace dinal::motion::rk4 {

struct Rk4Checkpoint {
    std::size_t step = 0;
    model::State state;
    double M = 0;
    LoneContact::Mark mark;
};

class Rk4Engine {
public:
    /// `events` and `checkpoints` may be null: a replay keeps neither.
    Rk4Engine(const Problem& problem, const Rk4& options, RowWriter& rows, std::vector<model::Event>* events,
              Checkpoints<Rk4Checkpoint>* checkpoints);

    /// Runs from a checkpoint to the end of the given step; by default the whole window.
    model::Outcome run();
    model::Outcome run(const Rk4Checkpoint& from, std::size_t last_step);

    const engine::StepTimes& steps() const { return steps_; }
    Rk4Checkpoint here(std::size_t step) const { return {step, y_, M_, contact_.mark()}; }
    /// Stores the time and state reached.
    void leave(Run& run) const {
        run.t_stop = t_;
        run.state_at_stop = y_;
        run.motion_at_stop = contact_.motion();
        run.began_stuck = contact_.began_stuck();
    }

private:
    /// M in the middle and at the end of a step, if known.
    struct Loads {
        double middle, end;
    };
    double time(std::size_t n) const { return steps_.time(n); }
    /// The result of one smooth step.
    struct Stepped {
        model::State y;
        double M;       ///< M at its end
        double a0, a1;  ///< accelerations at both ends
    };

    void begin_at(const Rk4Checkpoint& from);
    /// Samples the steps n, n + 1, ... that end before the next break; returns their number.
    std::size_t sample_block(std::size_t n, std::size_t last_step);
    bool run_block(std::size_t n, std::size_t count);
    std::size_t move(std::size_t n, std::size_t i, std::size_t count);
    std::size_t move_freely(std::size_t n, std::size_t i, std::size_t count);
    void end_block(std::size_t n, std::size_t first, std::size_t i);
    void block_rows(std::size_t n, std::size_t first, std::size_t last);
    std::size_t rest(std::size_t n, std::size_t i, std::size_t count);

    // Careful steps, for one step or a part of it:
    bool careful_step(double end, const Loads* known);
    bool piece(double end, bool break_at_end, const Loads* known);
    bool stay(double end, bool break_at_end, const Loads* known);
    bool reach_zero(const Stepped& whole, double zero, double end, bool break_at_end);
    Stepped step(double length, double end, bool break_at_end, const Loads* known) const;
    /// The states at which feedback is evaluated: those of the trial step, or, next to a jump at velocity zero, only
    /// those on the present side of it.
    enum class Evaluated { at_state, on_side_of_motion };
    Stepped feedback_step(double length, double end, bool break_at_end, Evaluated evaluated) const;
    bool lost_in_rounding(const model::State& y, double a) const;
    void record_turns(double t, double h, double direction, const model::State& y0, double a0, const model::State& y1,
                      double a1);
    std::optional<double> release_time(double end, bool break_at_end, const Loads* known, double& M_end) const;

    void rows_until(double end, const StepInterpolant& motion);
    void rows_standing_until(double end);
    void put_row(const model::State& y, double M) {
        if (std::isfinite(M) && std::isfinite(y.theta) && std::isfinite(y.velocity)) {
            rows_.put(y, M, model::friction_torque(system_, contact_.motion(), M, y));
        } else {
            failed_ = true;
        }
    }
    LoneContact::Standstill standstill() const { return {t_, y_.theta, M_}; }
    void stop_at_end();
    /// Lets the friction law decide about a mass at velocity zero.
    bool decide() {
        y_.theta = contact_.place_at_stop(standstill());
        return contact_.decide(standstill());
    }
    /// Continues after a decision at velocity zero; `sane` is false after endless standstills.
    bool continue_if(bool sane) {
        friction_ = system_.braking(contact_.motion());
        return sane ? finite() : fail(model::Outcome::chattering);
    }
    bool fail(model::Outcome outcome) {
        outcome_ = outcome;
        return false;
    }
    [[nodiscard]] bool finite() {
        if (!std::isfinite(M_)) return fail(model::Outcome::excitation_not_finite);
        if (!std::isfinite(y_.theta) || !std::isfinite(y_.velocity)) return fail(model::Outcome::state_not_finite);
        return !failed_ || fail(model::Outcome::excitation_not_finite);
    }
    double M_at(double t, double end, bool break_at_end, const model::State& y) const {
        return break_at_end && t == end ? excitation_.value_before(t, y) : excitation_.value(t, y);
    }
    /// F/I for the torque M in the present direction of motion.
    double forcing(double M) const { return (M - friction_) * block_.inverse_inertia; }
    /// theta'' under a torque that depends on the motion: M at this state, and the remainder of friction.
    double acceleration_at(const model::State& y, double M) const {
        return acceleration(forcing(M - system_.remainder(contact_.motion(), y)), y);
    }
    double acceleration(double f, const model::State& y) const {
        return f - block_.map.c * y.velocity - block_.map.w * y.theta;
    }

    model::Lowered system_;
    const model::Excitation& excitation_;
    const Monitor& monitor_;
    model::State initial_;
    Window window_;
    RowWriter& rows_;
    Checkpoints<Rk4Checkpoint>* checkpoints_;

    engine::AffineBlock block_;
    engine::StepTimes steps_;
    std::size_t steps_per_row_;
    bool feedback_;

    double t_ = 0;  // the present: time, state, M (from the right), motion
    model::State y_;
    double M_ = 0;
    LoneContact contact_;
    double friction_ = 0;  // constant friction torque of the present motion
    bool failed_ = false;  // whether M was not finite at a row between the steps
    model::Outcome outcome_ = model::Outcome::reached_end;
};

}  // namespace dinal::motion::rk4
