#include "support/heun.hpp"

#include <algorithm>
#include <cmath>

#include "model/sticking.hpp"
#include "motion/interpolation.hpp"
#include "motion/rows.hpp"

namespace dinal::truth {

namespace {

using model::State;

class Walk {
public:
    Walk(const motion::Problem& problem, double h)
        : problem_(problem),
          system_(problem.system),
          rows_(problem.system, problem.rows, run_),
          h_(h),
          t_(problem.window.start) {
        y_ = problem.initial;
        motion_ = problem.before.value_or(model::motion_of(y_.velocity));
        standstill_ = y_.velocity == 0 && !problem.before;
    }

    motion::Trajectory all() {
        while (t_ < problem_.window.end && std::isfinite(y_.theta)) {
            if (standstill_) ask_the_law();
            const double limit = std::min({t_ + h_, problem_.excitation.next_break(t_), problem_.window.end});
            motion_ == model::Motion::stuck ? stay(limit) : move(limit);
            at_start_ = at_start_ && t_ == problem_.window.start;
        }
        if (standstill_) ask_the_law();
        rows_before(model::never, t_);
        if (motion_ == model::Motion::stuck) run_.outcome = model::Outcome::stuck_at_end;
        rows_.finish();
        run_.events = motion::Growing<model::Event>(std::move(events_));
        run_.t_start = problem_.window.start;
        run_.t_stop = t_;
        run_.state_at_stop = y_;
        run_.motion_at_stop = motion_;
        return std::move(run_);
    }

private:
    [[nodiscard]] double M(double t, const State& y, double limit) const {
        return t == limit ? problem_.excitation.value_before(t, y) : problem_.excitation.value(t, y);
    }
    [[nodiscard]] double acceleration(double M, const State& y) const {
        const double friction = system_.braking(motion_) + system_.remainder(motion_, y);
        const model::Oscillator& s = problem_.system;
        return (M - friction - s.damping() * y.velocity - s.stiffness() * y.theta) / s.inertia();
    }
    /// The state at t, in one step from the present. M jumps at `limit`, if anywhere.
    [[nodiscard]] State after(double t, double limit) const {
        const double dt = t - t_;
        // Feedback at the very moment of velocity zero is that of the motion that begins.
        const State from{y_.theta, y_.velocity == 0 ? 1e-300 * model::sign_of(motion_) : y_.velocity};
        const double a0 = acceleration(problem_.excitation.value(t_, from), y_);
        const State guess{y_.theta + dt * y_.velocity, y_.velocity + dt * a0};
        const double a1 = acceleration(M(t, guess, limit), guess);
        return {y_.theta + dt * (y_.velocity + guess.velocity) / 2, y_.velocity + dt * (a0 + a1) / 2};
    }

    void move(double limit) {
        const double sign = model::sign_of(motion_);
        const auto against = [&](double t) { return -sign * after(t, limit).velocity; };
        double end = limit;
        if (against(limit) >= 0) {
            // From velocity zero the first moment is none.
            double from = t_;
            if (y_.velocity == 0) from = t_ + (limit - t_) * 0x1p-20;
            if (against(from) < 0)
                end = motion::first_positive(against, from, against(from), limit, against(limit)).second;
            standstill_ = true;
        }
        rows_before(end, limit);
        y_ = after(end, limit);
        t_ = end;
        if (standstill_) y_.velocity = 0;
    }

    void stay(double limit) {
        const auto excess = [&](double t) { return model::breakaway_excess(system_, M(t, y_, limit), y_.theta); };
        const bool leaves = leaves_at(t_) || excess(limit) > 0;
        const double end = leaves_at(t_) ? t_
                           : !leaves     ? limit
                                         : motion::first_positive(excess, t_, excess(t_), limit, excess(limit)).second;
        rows_before(end, limit);
        t_ = end;
        if (leaves) {
            motion_ = model::motion_of(problem_.excitation.value(t_, y_) - problem_.system.stiffness() * y_.theta);
            record(model::EventKind::slip);
        }
    }
    [[nodiscard]] bool leaves_at(double t) const {
        return model::motion_from_standstill(system_, problem_.excitation.value(t, y_), y_.theta) !=
               model::Motion::stuck;
    }

    void ask_the_law() {
        standstill_ = false;
        const model::Motion before = motion_;
        motion_ = model::motion_from_standstill(system_, problem_.excitation.value(t_, y_), y_.theta);
        if (at_start_) run_.began_stuck = motion_ == model::Motion::stuck;
        if (at_start_ || motion_ == before) return;
        record(motion_ == model::Motion::stuck ? model::EventKind::stick : model::EventKind::turn);
    }
    void record(model::EventKind kind) { events_.push_back({t_, kind, y_.theta, problem_.excitation.value(t_, y_)}); }

    void rows_before(double end, double limit) {
        while (rows_.next_time() < end) {
            const double t = rows_.next_time();
            const State y =
                motion_ == model::Motion::stuck || t <= t_ || t_ >= problem_.window.end ? y_ : after(t, limit);
            const double load = problem_.excitation.value(t, y);
            rows_.put(y, load, model::friction_torque(system_, motion_, load, y));
        }
    }

    const motion::Problem& problem_;
    model::Lowered system_;
    motion::Trajectory run_;
    motion::RowWriter rows_;
    std::vector<model::Event> events_;
    double h_, t_;
    State y_;
    model::Motion motion_ = model::Motion::stuck;
    bool standstill_ = false, at_start_ = true;
};

}  // namespace

motion::Trajectory Heun::run(const motion::Problem& problem) const {
    return Walk(problem, h).all();
}

}  // namespace dinal::truth
