// What happens at velocity zero, for every integrator: the friction law is asked here, and the events are told here.
//
// An integrator writes its smooth motion. It finds where the velocity comes down to zero, and where a pull passes the
// limit of sticking, says so, and is told what the mass does.
#pragma once

#include <cmath>
#include <vector>

#include "model/sticking.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion {

class Standstill {
public:
    enum class Phase {
        moving,   ///< the velocity is not zero, or zero means nothing (see passes())
        arrived,  ///< velocity zero, and the law has not been asked yet
        leaving,  ///< velocity zero, and the law lets it go
        stuck,
        held,      ///< stuck within rounding of the limit: it was let go, and did not get under way
        creeping,  ///< slower than rounding, but on its way: friction slides, and balances M and the spring
    };
    /// The mass at velocity zero. M is what a mass at rest is under, from the right where it jumps.
    struct Moment {
        double t, theta, M;
    };

    /// `events` may be null: then nothing is told. Many standstills, each no later than `at_once` after the one before,
    /// are a feedback that pushes at rest and holds in motion, and no motion.
    Standstill(const Problem& problem, std::vector<model::Event>* events, double at_once);

    [[nodiscard]] Phase phase() const { return phase_; }
    /// It stands, for all that numbers can tell.
    [[nodiscard]] bool stuck() const {
        return phase_ == Phase::stuck || phase_ == Phase::held || phase_ == Phase::creeping;
    }
    /// Which way the mass moves, or creeps; before it has moved at all without dry friction, `stuck`.
    [[nodiscard]] model::Motion motion() const { return motion_; }
    /// Without dry friction the mass swings through zero: its turns are told by turned(), and nothing is asked.
    [[nodiscard]] bool passes() const { return !system_.dry(); }
    /// Which way a mass at rest would go under M, or that it sticks. Of one that creeps: the way it is on, or
    /// the other way when it comes to a stop.
    [[nodiscard]] model::Motion pulled(double M, double theta) const {
        if (phase_ == Phase::creeping) return pulled_on(M, theta);
        return model::motion_from_standstill(system_, M, theta);
    }
    /// What M - k theta must pass towards this side before something happens: the breakaway torque, or, of a mass that
    /// creeps, what it is under, but for rounding.
    [[nodiscard]] double limit(model::Motion side) const {
        if (phase_ != Phase::creeping) return system_.holding(side);
        return side == motion_ ? apart_ + balance() : apart_ - balance();
    }
    /// How far M is past the limit; positive exactly when the law lets go.
    [[nodiscard]] double excess(double M, double theta) const;
    /// M cannot move it any more, whatever comes: it is constant, or nowhere great enough.
    [[nodiscard]] bool for_good(const Moment& now) const;
    /// The state at which a feedback that jumps at velocity zero is asked for this motion: not beyond zero, and at zero
    /// a hair of velocity on its way.
    [[nodiscard]] model::State on_its_way(const model::State& y) const;
    /// Whether a feedback jumps at velocity zero. What tries both sides of it within a step finds a way between them
    /// that is none.
    [[nodiscard]] bool jumps(double t, double theta) const;

    /// M for a mass that has come to rest, where an integrator has M: a feedback is asked at velocity zero, not at what
    /// is left of the velocity.
    [[nodiscard]] double M_at_rest(double t, double theta, double M) const {
        return feedback_ ? excitation_.value(t, {theta, 0}) : M;
    }

    /// Where the mass stands that has arrived: theta, or, past the limit of sticking by no more than the roundings of
    /// its way there, the place at the limit, which holds it.
    [[nodiscard]] double arrived_at(const Moment& now) const;

    /// The velocity is down to zero.
    void arrive() { phase_ = Phase::arrived; }
    /// The velocity is down to what is rounding. Where more than the friction of sliding would hold a standing mass,
    /// and that alone balances M and the spring, the mass is on its way for ever, and creeps: else this is false.
    bool creep(const Moment& now);

    // What returns false has seen standstills without end.

    /// After arrive(): the law says what the mass does, which is told.
    bool ask(const Moment& now);
    /// Stuck until now, or creeping; M has passed the limit of this side.
    bool release(const Moment& now, model::Motion towards);
    /// It was leaving and did not get under way: M only touched the limit. The mass stays where it is.
    bool never_left(const Moment& now);

    /// Time has passed since, in motion or at rest.
    void go_on();
    /// Without dry friction: it is on its way there, which is not told.
    void head(model::Motion motion) { motion_ = motion; }
    /// Without dry friction: it has turned.
    void turned(const Moment& now);
    /// At the end of the run. Whether it stands.
    bool finish();
    /// At the end of a run that got nowhere for standstills without end: the events of these, each at once after the
    /// one before, are none, but for the first.
    void forget_chatter();

    /// Where a run may be taken up again.
    struct Mark {
        model::Motion motion = model::Motion::stuck;
        Phase phase = Phase::moving;
        double apart = 0;
    };
    [[nodiscard]] Mark mark() const { return {motion_, phase_, apart_}; }
    void return_to(const Mark& mark) { motion_ = mark.motion, phase_ = mark.phase, apart_ = mark.apart; }

    /// From the start of the run until something moved it.
    [[nodiscard]] bool began_stuck() const { return began_stuck_; }
    /// Of the last event, `never` ago when there was none.
    [[nodiscard]] double last_told() const {
        return events_ == nullptr || events_->empty() ? -model::never : events_->back().t;
    }

private:
    [[nodiscard]] bool at_start(double t) const { return t <= start_; }
    [[nodiscard]] bool only_touched(const Moment& now) const;
    [[nodiscard]] double torques(const Moment& now) const {
        return std::fabs(now.M) + std::fabs(system_.pull_back(now.theta)) + system_.greatest_holding();
    }
    /// What friction takes while the mass creeps.
    [[nodiscard]] double balance() const { return model::sign_of(motion_) * system_.braking(motion_); }
    [[nodiscard]] model::Motion pulled_on(double M, double theta) const;
    void tell(model::EventKind kind, const Moment& now);
    bool goes_on_after(double t);

    model::Lowered system_;
    const model::Excitation& excitation_;
    bool feedback_;
    double constant_from_, most_M_;
    double start_;  // nothing is an event there
    double at_once_, pace_;
    std::vector<model::Event>* events_;

    model::Motion motion_;
    Phase phase_ = Phase::moving;
    model::Motion came_ = model::Motion::stuck;  // which way it moved before it stuck,
    double M_stuck_ = 0;                         // and under which M
    double torques_before_;                      // at the standstill before
    Moment crept_{};                             // since when it creeps
    double apart_ = 0;                           // how far M may be from what balances a creep
    bool began_stuck_ = false;
    double last_ = -model::never;  // standstill
    int at_once_in_a_row_ = 0;
};

}  // namespace dinal::motion
