// The state and events of the single contact of a mass on the ground, for exact and rk4. The rules are in contact.hpp.
//
// An integrator computes the smooth motion. It reports when the velocity reaches zero or a pull passes the limit of
// sticking; this class says how the mass continues.
#pragma once

#include <cmath>
#include <vector>

#include "model/sticking.hpp"
#include "motion/contact.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion {

class LoneContact {
public:
    enum class Phase {
        moving,   ///< velocity not zero, or zero is not special (see passes())
        arrived,  ///< velocity zero, not yet decided
        leaving,  ///< velocity zero, released by the friction law
        stuck,
        held,      ///< stuck within rounding of the limit: it was released, but did not start
        creeping,  ///< slower than rounding, yet sliding: friction balances M and the spring
    };
    /// The mass at velocity zero. M is its value for a mass at rest, from the right at a jump.
    struct Standstill {
        double t, theta, M;
    };

    /// `events` may be null. Many decisions, each within `at_once` of the one before, are chatter: a feedback that
    /// pushes at rest and brakes in motion.
    LoneContact(const Problem& problem, std::vector<model::Event>* events, double at_once);

    Phase phase() const { return phase_; }
    /// Returns whether the mass is at rest to rounding.
    bool stuck() const { return phase_ == Phase::stuck || phase_ == Phase::held || phase_ == Phase::creeping; }
    /// The direction of motion or creep; `stuck` if there is no dry friction and the mass has not moved yet.
    model::Motion motion() const { return motion_; }
    /// Returns whether there is no dry friction: the mass swings through zero, and only turned() records events.
    bool passes() const { return !system_.dry(); }
    /// The direction in which M moves a mass at rest, or `stuck`. A creeping mass keeps its direction, or reverses when
    /// it has stopped.
    model::Motion pulled(double M, double theta) const {
        const model::Pull pull = pull_of(M, theta);
        return pull.beyond > 0 ? pull.towards : model::Motion::stuck;
    }
    /// The limit of M - k theta towards this side: the breakaway torque, or for a creeping mass the sliding friction,
    /// with a margin for rounding.
    double limit(model::Motion side) const {
        if (phase_ != Phase::creeping) return system_.holding(side);
        return contact::limit_of_creep(side, motion_, balance(), apart_);
    }
    /// The excess of M over the limit; positive exactly if the law releases the mass.
    double excess(double M, double theta) const { return pull_of(M, theta).beyond; }
    /// Returns whether M can never move the mass again, because M is constant or never large enough.
    bool for_good(const Standstill& now) const;
    /// The state at which to evaluate a feedback that jumps at velocity zero: at or beyond zero, the smallest velocity
    /// in the direction of motion.
    model::State on_side_of_motion(const model::State& y) const;
    /// Returns whether a feedback jumps at velocity zero. A step that evaluated it on both sides would find a
    /// compromise that does not exist.
    bool jumps(double t, double theta) const;

    /// M at the stop; a feedback sees velocity exactly 0, not the residual.
    double M_at_rest(double t, double theta, double M) const {
        return feedback_ ? excitation_.value(t, {theta, 0}) : M;
    }

    /// The angle of a mass that has stopped: theta, or if that exceeds the limit of sticking by no more than
    /// accumulated rounding, the angle at the limit.
    double place_at_stop(const Standstill& now) const;

    /// Reports that the velocity has reached zero.
    void arrive() { phase_ = Phase::arrived; }
    /// Reports that the velocity is below rounding. Returns true, and creeps, if sliding friction alone balances M and
    /// the spring while breakaway friction is larger: such a mass slows down for ever.
    bool creep(const Standstill& now);

    // The following functions return false after too many decisions in a row (chatter).

    /// Decides after arrive(), and records the event.
    bool decide(const Standstill& now);
    /// Leaves a stick or a creep: M has passed the limit of this side.
    bool release(const Standstill& now, model::Motion towards);
    /// Returns to sticking after a release without motion: M only touched the limit.
    bool failed_to_leave(const Standstill& now);

    void note_time_passed();
    /// Without dry friction: sets the direction, without an event.
    void set_direction(model::Motion motion) { motion_ = motion; }
    /// Without dry friction: reverses, and records the turn.
    void turned(const Standstill& now);
    /// Ends the run; returns whether the mass is at rest.
    bool finish();
    /// Ends a run of endless decisions: removes their events except the first.
    void forget_chatter();

    /// The state needed to resume a run.
    struct Mark {
        model::Motion motion = model::Motion::stuck;
        Phase phase = Phase::moving;
        double apart = 0;
    };
    Mark mark() const { return {motion_, phase_, apart_}; }
    void return_to(const Mark& mark) { motion_ = mark.motion, phase_ = mark.phase, apart_ = mark.apart; }

    /// Returns whether it was stuck from the start until something moved it.
    bool began_stuck() const { return began_stuck_; }
    /// The time of the last event, -never if there was none.
    double last_event_time() const {
        return events_ == nullptr || events_->empty() ? -model::never : events_->back().t;
    }

private:
    bool at_start(double t) const { return t <= start_; }
    double torques(const Standstill& now) const {
        return std::fabs(now.M) + std::fabs(system_.pull_back(now.theta)) + system_.greatest_holding();
    }
    /// The friction torque of a creeping mass.
    double balance() const { return model::sign_of(motion_) * system_.braking(motion_); }
    model::Pull pull_of(double M, double theta) const {
        if (phase_ != Phase::creeping) return model::pull_at_rest(system_, M, theta);
        return contact::pull_on_creep(std::fma(-system_.stiffness(), theta, M), motion_, balance(), apart_);
    }
    void stick(const Standstill& now);
    void record_event(model::EventKind kind, const Standstill& now);
    bool goes_on_after(double t);

    model::Lowered system_;
    const model::Excitation& excitation_;
    bool feedback_;
    double constant_from_, most_M_;
    double start_;  // start of the run, which is never an event
    double at_once_, pace_;
    std::vector<model::Event>* events_;

    model::Motion motion_;
    Phase phase_ = Phase::moving;
    model::Motion came_ = model::Motion::stuck;  // direction before it stuck
    double M_stuck_ = 0;                         // M when it stuck
    double torques_before_;                      // sum of torques at the last stop
    Standstill crept_{};                         // when it began to creep
    double apart_ = 0;                           // tolerance of M around the balance of a creep
    bool began_stuck_ = false;
    double last_ = -model::never;  // time of the last decision
    int at_once_in_a_row_ = 0;
};

}  // namespace dinal::motion
