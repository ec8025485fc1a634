#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "motion/engine/engine.hpp"

namespace dinal::motion::engine {

using model::Joint;
using model::Motion;
using model::Outcome;

namespace {

// a run ends this close to the failure of a function, in time units of the motion
constexpr double near_failure = 1e-9;
constexpr int most_attempts = 20000;
constexpr int most_attempts_sampled = 3000;  // if a function of the motion is only known by samples
constexpr double huge = 1e100;               // beyond this a non-finite value is not blamed on the function

/// Returns the time for which a polynomial of degree 16 can follow a motion under a friction law from this speed on. On
/// a straight range that is limited by its rate of growth or decay, on a curve by the time until the speed has changed
/// by law.scale(). `first` and `second` are the first two time derivatives of the speed, `second` as a magnitude.
double longest_step(const model::Friction& law, const model::SpeedRange& range, double speed, double first,
                    double second, double C, double I) {
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr double steepest = 4;  // greatest a t for which a polynomial of degree 16 follows exp(-a t)
    if (range.straight) {
        const double a = (C + range.slope) / I;
        const bool begins = speed == range.from || speed == range.to;
        return a < 0 || begins ? steepest / std::fabs(a) : any;
    }
    // The scale of a law grows with speed, so for decreasing speed the scale at the end of the step matters.
    double change = law.scale(speed);
    if (first < 0) {
        for (int i = 0; i < 4; ++i) change = law.scale(std::max(0.0, speed - change));
    }
    second += std::fabs(law.slope(speed) * first) / I;
    const double root = std::sqrt(first * first + 2 * second * change) + std::fabs(first);
    return root > 0 ? 2 * change / root : any;
}

}  // namespace

void Engine::set_pace() {
    constexpr double part_of_run = 1.0 / 16;
    const double run = problem_.window.end - problem_.window.start;
    Mode free = now_.mode;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) free.friction[j].way = Motion::forward, free.leans[j] = 0;
    const double w = mechanics_.fastest(Frame(problem_.system, free));
    pace_.born = problem_.before ? problem_.before->born : now_.t.hi;
    pace_.period = w > 0 ? 2 * std::numbers::pi / w : model::never;
    pace_.unit = std::min(pace_.period, run);
    pace_.longest = std::min(problem_.longest, w > 0 ? longest_in_periods * pace_.period : part_of_run * run);
    pace_.h = pace_.longest / 2;
    chatter_ = {now_.t.hi, pace_.unit};
}

/// Returns the time of the next known break, also of a user's event.
double Engine::next_break() const {
    double next = std::min(mechanics_.next_break(now_.t.hi), breaks_.next());
    for (const model::WantedEvent& event : problem_.drive.events) {
        next = std::min(next, event.when->next_break(now_.t.hi));
    }
    return next;
}

void Engine::choose(const Frame& frame) {
    const double breaks = next_break();
    double limit = std::min(problem_.window.end, breaks);
    if (problem_.step > 0) {
        // A break within rounding of a step's end counts as that end.
        const double beside = std::max(1e-9 * problem_.step, 4 * rounding * std::fabs(now_.t.hi));
        const double steps = std::floor((now_.t.hi - problem_.window.start + beside) / problem_.step) + 1;
        const double step_end = problem_.window.start + steps * problem_.step;
        if (step_end < limit - beside) limit = step_end;
    }
    double h = std::min({rung(pace_.h, frame.longest / 2), mechanics_.view(now_.t.hi, cheb::widest_gap) / 2,
                         breaks_.shortest_delay() / 2 * (1 - 1e-12)});
    if (pace_.bad_time < model::never) h = std::min(h, now_.t.until(pace_.bad_time) / 4);
    if (problem_.step == 0) h = std::min(h, longest_under_friction(frame) / 2);
    // The stretch reaches just past the wall, or past the return to it, so that a small bounce is resolved.
    if (walls_.any) h = std::min(h, std::max(0.6 * until_wall(frame), 1e-9 * pace_.unit));
    const double remaining = now_.t.until(limit);
    const bool to_limit = remaining <= 2 * h * (1 + 1e-9);
    segment_.start = now_.t;
    segment_.h = to_limit ? remaining / 2 : remaining < 4 * h ? remaining / 4 : h;
    segment_.end = to_limit ? limit : now_.t.after(2 * segment_.h);
    segment_.from_break = now_.after_break;
    segment_.to_break = to_limit && limit == breaks;
    segment_.to_the_end = to_limit;
    segment_.may_grow = pace_.h < frame.longest / 2;
    segment_.slides = conditions_->slides().any();
}

/// Returns the time to the next wall under constant accelerations.
double Engine::until_wall(const Frame& frame) {
    double first = model::never;
    if (!balances_->at_present(now_, frame, segment_, room_.balance)) return first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Walls* walls = joint.any_walls();
        if (walls == nullptr || now_.mode.holds(j) || now_.mode.presses[j] != 0) continue;
        const double rate = joint.sum(room_.balance.accelerations);
        for (const int wall : {1, -1}) {
            const double apart = std::max(0.0, wall * now_.gap(problem_.system.joints[j], walls->at(wall)));
            const double v = wall * mechanics_.velocity(j, now_.y);
            const double a = wall * rate, root = v * v + 2 * a * apart;
            if (!(root >= 0) || !(apart < model::never)) continue;
            const double t = v > 0   ? 2 * apart / (v + std::sqrt(root))
                             : a > 0 ? (std::sqrt(root) - v) / a
                                     : model::never;
            if (t > 0) first = std::min(first, t);
        }
    }
    return first;
}

/// Returns the longest stretch that friction laws with a curved dependence on speed allow.
double Engine::longest_under_friction(const Frame& frame) {
    double longest = model::never;
    bool looked = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Friction& law = joint.friction.law;
        const Slipping& how = now_.mode.friction[j];
        if (law.ranges() == 0 || how.way == Motion::stuck || how.riding || now_.mode.leans[j] != 0) continue;
        if (!looked && !balances_->at_present(now_, frame, segment_, room_.balance)) return longest;
        looked = true;
        const double sign = model::sign_of(how.way);
        const double lightness = joint.lightness(problem_.system.bodies),
                     first = joint.sum(room_.balance.accelerations);
        const double C = joint.damping, v = mechanics_.velocity(j, now_.y);
        const double second = (std::fabs(joint.stiffness * v) + std::fabs(C * first)) * lightness;
        longest =
            std::min(longest, longest_step(law, law.range(how.range), std::max(0.0, sign * now_.slip(mechanics_, j)),
                                           sign * first, second, C, 1 / lightness));
    }
    return longest;
}

void Engine::retry(Flow::Attempt attempt) {
    const int most = conditions_->samples() ? most_attempts_sampled : most_attempts;
    if (chatter_.too_many_attempts(now_.t.hi, most)) {
        fail(conditions_->samples() ? Outcome::chattering : Outcome::unresolved);
        return;
    }
    if (attempt == Flow::Attempt::failed) {
        pace_.bad_time = solver_->bad_time();
        const double near = std::max(near_failure * pace_.unit, 64 * rounding * std::fabs(now_.t.hi));
        const bool there = now_.t.until(pace_.bad_time) <= near && !solver_->strayed();
        if (problem_.step > 0 || there || !mechanics_.may_go_on())
            fail(now_.greatest_of_state() > huge ? Outcome::state_not_finite : Outcome::excitation_not_finite);
        pace_.h = segment_.h / 2;
        return;
    }
    if (solver_->found_noise(segment_, now_.mode)) return;
    if (!breaks_.has_too_many() && pace_.may_search(now_.t.hi, segment_.h)) {
        const auto found = solver_->found_break(segment_);
        if (found && *found > now_.t.hi && breaks_.add(*found)) {
            if (a_belt_jumps_at(*found)) mechanics_.jumps_at(*found);
            return;
        }
    }
    pace_.shorten(segment_.h, solver_->unresolved(), frames_->of(now_.mode).longest);
}

void Pace::shorten(double half, double unresolved, double longest_now) {
    // an error up to this multiple of the tolerance also limits the length of the next stretches
    constexpr double slightly = 16;
    constexpr int limited_stretches = 12;
    const double factor = unresolved < model::never ? 0.9 * std::pow(unresolved, -1.0 / 16) : 0;
    h = half * std::clamp(factor, 0.5, 0.9);
    if (unresolved <= slightly && h > short_part * longest_now) short_enough_ = h, limited_for_ = limited_stretches;
}

void Pace::lengthen(double half, double factor, double longest_now) {
    h = std::min(longest_now / 2, std::max(h, half * factor));
    if (h >= whole_) whole_ = 0;
    if (limited_for_ > 0 && --limited_for_ > 0) h = std::min(h, short_enough_);
}

}  // namespace dinal::motion::engine
