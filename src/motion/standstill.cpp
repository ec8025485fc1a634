#include "motion/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dinal::motion {

namespace {

/// More successive standstills than this count as chatter.
constexpr int most_at_once = 200;
/// The longest stick that can be an artefact of rounding, as a part of T0.
constexpr double briefly = 1e-3;
/// The bound of the impulse that friction withholds in such a stick, in torques times a radian of the free motion.
constexpr double withheld = 64 * std::numeric_limits<double>::epsilon();
/// The rounding error that theta accumulates in a long motion, relative to the torques.
constexpr double rounding_of_torques = 1024 * std::numeric_limits<double>::epsilon();
/// A velocity that only shows a direction.
constexpr double hair = std::numeric_limits<double>::min();

}  // namespace

Standstill::Standstill(const Problem& problem, std::vector<model::Event>* events, double at_once)
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

double Standstill::excess(double M, double theta) const {
    if (phase_ == Phase::creeping) {
        const double off = model::sign_of(motion_) * std::fma(-system_.stiffness(), theta, M) - balance();
        return std::fabs(off) - apart_;
    }
    const double excess = model::breakaway_excess(system_, M, theta);
    return pulled(M, theta) == model::Motion::stuck ? std::min(excess, 0.0) : excess;
}

model::Motion Standstill::pulled_on(double M, double theta) const {
    const double off = model::sign_of(motion_) * std::fma(-system_.stiffness(), theta, M) - balance();
    if (!(std::fabs(off) > apart_)) return model::Motion::stuck;
    return (off > 0) == (motion_ == model::Motion::forward) ? model::Motion::forward : model::Motion::backward;
}

bool Standstill::creep(const Moment& now) {
    if (feedback_ || system_.has_remainder() || passes() || motion_ == model::Motion::stuck) return false;
    if (!(system_.holding(motion_) > balance())) return false;  // its breakaway torque does not exceed sliding friction
    const double off =
        std::fabs(model::sign_of(motion_) * std::fma(-system_.stiffness(), now.theta, now.M) - balance());
    if (!(off <= rounding_of_torques * torques(now))) return false;
    phase_ = Phase::creeping;
    crept_ = now;
    constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
    apart_ = 2 * off + rounding * torques(now);
    return true;
}

bool Standstill::for_good(const Moment& now) const {
    if (!stuck()) return false;
    if (phase_ != Phase::creeping && model::cannot_break_away(system_, most_M_, now.theta)) return true;
    return constant_from_ <= now.t && pulled(now.M, now.theta) == model::Motion::stuck;
}

model::State Standstill::on_side_of_motion(const model::State& y) const {
    const double way = model::sign_of(motion_);
    return {y.theta, way * y.velocity > 0 ? y.velocity : way * hair};
}

bool Standstill::jumps(double t, double theta) const {
    if (!feedback_ || passes()) return false;
    constexpr double rounding = 1e-12;  // relative rounding of a user's formula
    const double above = excitation_.value(t, {theta, hair}), below = excitation_.value(t, {theta, -hair});
    const double torques = std::fabs(above) + std::fabs(below) + system_.greatest_holding();
    return std::fabs(above - below) > rounding * torques;
}

double Standstill::place_at_stop(const Moment& now) const {
    const double k = system_.stiffness();
    if (at_start(now.t) || k == 0 || feedback_ || system_.has_spring()) return now.theta;
    const double rounding = rounding_of_torques * std::max(torques(now), torques_before_);
    if (phase_ != Phase::creeping) {  // quick test: most are clearly off the limit
        const double torque = now.M - k * now.theta;
        const double over = std::fabs(torque) - system_.holding(model::motion_of(torque));
        if (!(std::fabs(over) <= 2 * rounding)) return now.theta;
    }
    const model::Motion way = pulled(now.M, now.theta);
    if (way == model::Motion::stuck || excess(now.M, now.theta) > rounding) return now.theta;
    const double side = model::sign_of(way);
    double place = (now.M - side * system_.holding(way)) / k;
    while (pulled(now.M, place) == way) place = std::nextafter(place, side * model::never);
    return place;
}

bool Standstill::decide(const Moment& now) {
    const model::Motion before = motion_;
    torques_before_ = torques(now);
    motion_ = pulled(now.M, now.theta);
    phase_ = motion_ == model::Motion::stuck ? Phase::stuck : Phase::leaving;
    came_ = before, M_stuck_ = now.M;
    if (at_start(now.t)) {
        began_stuck_ = stuck();
    } else if (stuck()) {
        record_event(model::EventKind::stick, now);
    } else if (motion_ != before && before != model::Motion::stuck) {
        // Going on in the same direction is no event, nor is an initial velocity set at rest.
        record_event(model::EventKind::turn, now);
    }
    return goes_on_after(now.t);
}

bool Standstill::release(const Moment& now, model::Motion towards) {
    if (phase_ == Phase::creeping) {
        if (towards == motion_) {
            phase_ = Phase::leaving;
        } else {
            came_ = motion_, M_stuck_ = now.M;
            motion_ = model::Motion::stuck;
            phase_ = Phase::stuck;
            record_event(model::EventKind::stick, now);
        }
        return goes_on_after(now.t);
    }
    motion_ = towards;
    phase_ = Phase::leaving;
    if (was_rounding_artefact(now)) {
        if (towards == came_) {
            events_->pop_back();
        } else {
            events_->back().kind = model::EventKind::turn;
        }
    } else {
        record_event(model::EventKind::slip, now);
    }
    return goes_on_after(now.t);
}

/// Returns whether the stick that ends now is an artefact of rounding: the mass reached velocity zero right at the
/// limit, and friction withheld an impulse below rounding before M passed it.
bool Standstill::was_rounding_artefact(const Moment& now) const {
    if (events_ == nullptr || events_->empty() || came_ == model::Motion::stuck) return false;
    const model::Event& last = events_->back();
    const double part = (now.t - last.t) / pace_;
    if (last.kind != model::EventKind::stick || part > briefly) return false;
    return std::fabs(now.M - M_stuck_) * (2 * std::numbers::pi * part) <= withheld * torques(now);
}

bool Standstill::failed_to_leave(const Moment& now) {
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
        record_event(model::EventKind::stick, now);  // it stopped and did not start again
        came_ = motion_, M_stuck_ = now.M;
    }
    motion_ = model::Motion::stuck;
    phase_ = Phase::held;
    return goes_on_after(now.t);
}

void Standstill::go_on() {
    if (phase_ == Phase::leaving) phase_ = Phase::moving;
    if (phase_ == Phase::held) phase_ = Phase::stuck;
}

void Standstill::turned(const Moment& now) {
    motion_ = motion_ == model::Motion::forward ? model::Motion::backward : model::Motion::forward;
    record_event(model::EventKind::turn, now);
}

bool Standstill::finish() {
    if (!stuck()) return false;
    if (phase_ == Phase::creeping) record_event(model::EventKind::stick, crept_);  // no further motion follows
    return true;
}

void Standstill::forget_chatter() {
    if (events_ == nullptr) return;
    while (events_->size() > 1 && events_->back().t - (*events_)[events_->size() - 2].t <= at_once_) {
        events_->pop_back();
    }
}

void Standstill::record_event(model::EventKind kind, const Moment& now) {
    if (events_ != nullptr) events_->push_back({now.t, kind, now.theta, now.M});
}

bool Standstill::goes_on_after(double t) {
    at_once_in_a_row_ = t - last_ <= at_once_ ? at_once_in_a_row_ + 1 : 0;
    last_ = t;
    return at_once_in_a_row_ <= most_at_once;
}

}  // namespace dinal::motion
