#include "motion/standstill.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::motion {

namespace {

/// More standstills than this, each at once after the one before, lead nowhere.
constexpr int most_at_once = 200;
/// A velocity that is only a direction.
constexpr double hair = std::numeric_limits<double>::min();

}  // namespace

Standstill::Standstill(const Problem& problem, std::vector<model::Event>* events, double at_once)
    : system_(problem.system),
      excitation_(problem.excitation),
      feedback_(problem.excitation.has_feedback()),
      constant_from_(problem.excitation.constant_from()),
      most_M_(problem.excitation.most()),
      start_(problem.before ? -model::never : problem.window.start),
      at_once_(at_once),
      events_(events),
      motion_(problem.before.value_or(model::motion_of(problem.initial.velocity))) {
    if (passes()) return;
    if (problem.before == model::Motion::stuck) {
        phase_ = Phase::stuck;
    } else if (problem.initial.velocity == 0) {
        // The law was asked at the end of the part before.
        phase_ = problem.before ? Phase::leaving : Phase::arrived;
    }
}

double Standstill::excess(double M, double theta) const {
    const double excess = model::breakaway_excess(system_, M, theta);
    return pulled(M, theta) == model::Motion::stuck ? std::min(excess, 0.0) : excess;
}

bool Standstill::for_good(const Moment& now) const {
    if (!stuck()) return false;
    const double k_theta = system_.pull_back(now.theta);
    if (most_M_ - k_theta <= system_.holding(model::Motion::forward) &&
        most_M_ + k_theta <= system_.holding(model::Motion::backward)) {
        return true;
    }
    return constant_from_ <= now.t && pulled(now.M, now.theta) == model::Motion::stuck;
}

model::State Standstill::on_its_way(const model::State& y) const {
    const double way = model::sign_of(motion_);
    return {y.theta, way * y.velocity > 0 ? y.velocity : way * hair};
}

bool Standstill::jumps(double t, double theta) const {
    if (!feedback_ || passes()) return false;
    constexpr double rounding = 1e-12;  // of a formula
    const double above = excitation_.value(t, {theta, hair}), below = excitation_.value(t, {theta, -hair});
    const double torques = std::fabs(above) + std::fabs(below) + system_.greatest_holding();
    return std::fabs(above - below) > rounding * torques;
}

bool Standstill::ask(const Moment& now) {
    const model::Motion before = motion_;
    motion_ = pulled(now.M, now.theta);
    phase_ = motion_ == model::Motion::stuck ? Phase::stuck : Phase::leaving;
    if (at_start(now.t)) {
        began_stuck_ = stuck();
    } else if (stuck()) {
        tell(model::EventKind::stick, now);
    } else if (motion_ != before) {
        tell(model::EventKind::turn, now);  // the same direction again: it only touched zero, which is no event
    }
    return goes_on_after(now.t);
}

bool Standstill::release(const Moment& now, model::Motion towards) {
    motion_ = towards;
    phase_ = Phase::leaving;
    tell(model::EventKind::slip, now);
    return goes_on_after(now.t);
}

bool Standstill::never_left(const Moment& now) {
    if (last_told() == now.t) {
        model::Event& last = events_->back();
        if (last.kind == model::EventKind::slip) {
            events_->pop_back();
        } else if (last.kind == model::EventKind::turn) {
            last.kind = model::EventKind::stick;
        }
    } else if (at_start(now.t)) {
        began_stuck_ = true;
    } else {
        tell(model::EventKind::stick, now);  // it was on its way, came to rest, and did not go on
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
    tell(model::EventKind::turn, now);
}

bool Standstill::finish() {
    if (!stuck()) return false;
    if (events_ == nullptr) return true;
    const auto own = [](const model::Event& event) { return event.kind <= model::EventKind::rest; };
    const auto last = std::find_if(events_->rbegin(), events_->rend(), own);
    if (last != events_->rend()) last->kind = model::EventKind::rest;
    return true;
}

void Standstill::tell(model::EventKind kind, const Moment& now) {
    if (events_ != nullptr) events_->push_back({now.t, kind, now.theta, now.M});
}

bool Standstill::goes_on_after(double t) {
    at_once_in_a_row_ = t - last_ <= at_once_ ? at_once_in_a_row_ + 1 : 0;
    last_ = t;
    return at_once_in_a_row_ <= most_at_once;
}

}  // namespace dinal::motion
