#include "motion/lone_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::motion {

namespace {

/// More successive decisions than this count as chatter.
constexpr int most_at_once = 200;
/// A tiny velocity that only indicates a direction.
constexpr double tiny_velocity = std::numeric_limits<double>::min();

}  // namespace

LoneContact::LoneContact(const Problem& problem, std::vector<model::Event>* events, double at_once)
    : system_(problem.system),
      excitation_(problem.drive.M()),
      feedback_(problem.drive.M().has_feedback()),
      constant_from_(problem.drive.M().constant_from()),
      most_M_(problem.drive.M().most()),
      start_(problem.before ? -model::never : problem.window.start),
      at_once_(at_once),
      pace_(std::min(problem.system.natural_period(), problem.window.end - problem.window.start)),
      events_(events),
      motion_(problem.before.value_or(model::motion_of(problem.drive.start().velocity))),
      torques_before_(std::fabs(system_.pull_back(problem.drive.start().theta))) {
    if (passes()) return;
    if (problem.before == model::Motion::stuck) {
        phase_ = Phase::stuck;
    } else if (problem.drive.start().velocity == 0) {
        // The law was evaluated at the end of the first part.
        phase_ = problem.before ? Phase::leaving : Phase::arrived;
    }
}

bool LoneContact::creep(const Standstill& now) {
    if (feedback_ || system_.has_remainder() || passes() || motion_ == model::Motion::stuck) return false;
    const double pull = std::fma(-system_.stiffness(), now.theta, now.M);
    const auto within = contact::creeps_within(pull, motion_, balance(), system_.holding(motion_), torques(now));
    if (!within) return false;
    phase_ = Phase::creeping;
    crept_ = now;
    apart_ = *within;
    return true;
}

bool LoneContact::for_good(const Standstill& now) const {
    if (!stuck()) return false;
    if (phase_ != Phase::creeping && model::cannot_break_away(system_, most_M_, now.theta)) return true;
    return constant_from_ <= now.t && pulled(now.M, now.theta) == model::Motion::stuck;
}

model::State LoneContact::on_side_of_motion(const model::State& y) const {
    const double way = model::sign_of(motion_);
    return {y.theta, way * y.velocity > 0 ? y.velocity : way * tiny_velocity};
}

bool LoneContact::jumps(double t, double theta) const {
    if (!feedback_ || passes()) return false;
    constexpr double rounding = 1e-12;  // relative rounding of a user's formula
    const double above = excitation_.value(t, {theta, tiny_velocity}),
                 below = excitation_.value(t, {theta, -tiny_velocity});
    const double torques = std::fabs(above) + std::fabs(below) + system_.greatest_holding();
    return std::fabs(above - below) > rounding * torques;
}

double LoneContact::place_at_stop(const Standstill& now) const {
    const double k = system_.stiffness();
    if (at_start(now.t) || k == 0 || feedback_ || system_.has_spring()) return now.theta;
    const model::Pull pull = pull_of(now.M, now.theta);
    const double size = std::max(torques(now), torques_before_);
    return contact::place_at_limit(pull, system_.holding(pull.towards), k, now.M, now.theta, size);
}

bool LoneContact::decide(const Standstill& now) {
    const model::Motion before = motion_;
    torques_before_ = torques(now);
    const auto [way, event, creeps] = contact::decide({.slid = before}, pull_of(now.M, now.theta));
    motion_ = way;
    phase_ = way == model::Motion::stuck ? Phase::stuck : Phase::leaving;
    came_ = before, M_stuck_ = now.M;
    if (at_start(now.t)) {
        began_stuck_ = stuck();
    } else if (event) {
        record_event(*event, now);
    }
    return goes_on_after(now.t);
}

bool LoneContact::release(const Standstill& now, model::Motion towards) {
    const model::Motion crept = phase_ == Phase::creeping ? motion_ : model::Motion::stuck;
    const auto [way, event, creeps] =
        contact::decide({.held = crept == model::Motion::stuck, .creeps = crept}, {model::never, towards});
    if (way == model::Motion::stuck) {
        stick(now);
        return goes_on_after(now.t);
    }
    motion_ = way;
    phase_ = Phase::leaving;
    if (event && events_ != nullptr) {
        const model::Event slip{now.t, *event, now.theta, now.M};
        if (!contact::only_touched(*events_, {slip, came_, way, std::fabs(now.M - M_stuck_), torques(now)}, pace_))
            events_->push_back(slip);
    }
    return goes_on_after(now.t);
}

void LoneContact::stick(const Standstill& now) {
    record_event(model::EventKind::stick, now);
    came_ = motion_, M_stuck_ = now.M;
    motion_ = model::Motion::stuck;
    phase_ = Phase::stuck;
}

bool LoneContact::failed_to_leave(const Standstill& now) {
    if (last_event_time() == now.t) {
        model::Event& last = events_->back();
        if (last.kind == model::EventKind::slip) {
            events_->pop_back();
        } else if (last.kind == model::EventKind::turn) {
            last.kind = model::EventKind::stick;
        }
    } else if (at_start(now.t)) {
        began_stuck_ = true;
    } else {
        stick(now);  // it stopped and did not start again
    }
    motion_ = model::Motion::stuck;
    phase_ = Phase::held;
    return goes_on_after(now.t);
}

void LoneContact::note_time_passed() {
    if (phase_ == Phase::leaving) phase_ = Phase::moving;
    if (phase_ == Phase::held) phase_ = Phase::stuck;
}

void LoneContact::turned(const Standstill& now) {
    motion_ = motion_ == model::Motion::forward ? model::Motion::backward : model::Motion::forward;
    if (!at_start(now.t)) record_event(model::EventKind::turn, now);
}

bool LoneContact::finish() {
    if (!stuck()) return false;
    if (phase_ == Phase::creeping) record_event(model::EventKind::stick, crept_);  // no further motion follows
    return true;
}

void LoneContact::forget_chatter() {
    if (events_ == nullptr) return;
    while (events_->size() > 1 && events_->back().t - (*events_)[events_->size() - 2].t <= at_once_) {
        events_->pop_back();
    }
}

void LoneContact::record_event(model::EventKind kind, const Standstill& now) {
    if (events_ != nullptr) events_->push_back({now.t, kind, now.theta, now.M});
}

bool LoneContact::goes_on_after(double t) {
    at_once_in_a_row_ = t - last_ <= at_once_ ? at_once_in_a_row_ + 1 : 0;
    last_ = t;
    return at_once_in_a_row_ <= most_at_once;
}

}  // namespace dinal::motion
