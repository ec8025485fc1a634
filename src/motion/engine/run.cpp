#include "motion/engine/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "model/springs/user_spring.hpp"
#include "motion/engine/engine.hpp"
#include "motion/engine/guards.hpp"
#include "motion/engine/moving.hpp"
#include "motion/witness.hpp"

namespace dinal::motion::engine {

namespace {

using model::Event;
using model::EventKind;
using model::Joint;
using model::Motion;
using model::Outcome;

// In units of the pace, T0 or all of a run that is shorter.
constexpr double shortest = 1e-13;     // what cannot be seen in the motion
constexpr double near_failure = 1e-9;  // how near a run comes to where a function fails
constexpr int most_attempts = 20000;
constexpr int most_attempts_sampled = 3000;  // where a function of the motion is asked that may do anything
constexpr double huge = 1e100;               // a function that is no number at such a state says nothing about itself
constexpr double beyond_all = std::numeric_limits<double>::max() / 1e7;  // bounds of a series are so much greater

/// Returns about how long a polynomial of degree 16 can follow a motion under a law of friction from this speed on:
/// along a line that makes it grow or die out fast, and along a curve until the speed has changed by its scale. `first`
/// is the change of the speed by time, `second` the size of what that changes by.
double longest_step(const model::Friction& law, const model::SpeedRange& range, double speed, double first,
                    double second, double C, double I) {
    constexpr double any = std::numeric_limits<double>::infinity();
    constexpr double steepest = 4;  // what exp(-a t) may have for a t: degree 16 follows it then
    if (range.straight) {
        const double a = (C + range.slope) / I;
        const bool begins = speed == range.from || speed == range.to;
        return a < 0 || begins ? steepest / std::fabs(a) : any;
    }
    // Towards greater speeds a law becomes straighter; towards smaller ones what counts is where the step ends.
    double change = law.scale(speed);
    if (first < 0) {
        for (int i = 0; i < 4; ++i) change = law.scale(std::max(0.0, speed - change));
    }
    second += std::fabs(law.slope(speed) * first) / I;
    const double root = std::sqrt(first * first + 2 * second * change) + std::fabs(first);
    return root > 0 ? 2 * change / root : any;
}

}  // namespace

Engine::Engine(const Request& problem, Run& result)
    : problem_(problem),
      result_(result),
      asking_{.named = problem.system.named, .told = 2 * problem.system.bodies.size() + problem.drive.states.size()},
      mechanics_(problem.system, problem.drive, asking_),
      now_{.t = {problem.window.start, 0}},
      contacts_{.of = std::vector<Contacts::Of>(mechanics_.joints())},
      walls_(problem.system),
      breaks_(mechanics_),
      projection_(mechanics_, told_joints()),
      impulses_(mechanics_),
      users_(mechanics_, problem.drive.events),
      normal_halves_(mechanics_.joints(), 0) {
    const std::size_t joints = mechanics_.joints();
    now_.y = problem.drive.theta0;
    now_.y.insert(now_.y.end(), problem.drive.velocity0.begin(), problem.drive.velocity0.end());
    for (const model::OwnState& state : problem.drive.states) now_.y.push_back(state.start);
    now_.y.resize(2 * n() + mechanics_.states(), 0);
    now_.low.assign(n(), 0);
    now_.mode.friction.resize(joints), now_.mode.leans.assign(joints, 0);
    now_.mode.presses.assign(joints, 0), now_.mode.sliders.assign(mechanics_.sliders().size(), Motion::stuck);
    now_.mode.rubs = mechanics_.rubbing(), now_.mode.rigid.assign(joints, 0), now_.rigid_at.assign(joints, 0);
    for (std::size_t j = 0; j < joints; ++j) now_.mode.rigid[j] = problem.system.joints[j].rigid ? 1 : 0;
    if (problem.before != nullptr) {
        now_.y = problem.before->y;
        if (!problem.before->low.empty()) now_.low = problem.before->low;
        now_.mode = problem.before->mode;
        for (std::size_t j = 0; j < joints; ++j) contacts_.of[j].leaned = now_.mode.leans[j] != 0;
        for (std::size_t j = 0; j < joints; ++j) mechanics_.loads()[j].remember(problem.before->controllers[j]);
        breaks_.go_on_with(problem.before->echoes);
        if (!problem.before->watches.empty()) users_.go_on_with(problem.before->watches);
    }
    now_.keep_rigid_places(problem_.system);
    recorder_.emplace(problem, mechanics_, result, now_);
    if (problem.before != nullptr && !problem.before->heading.empty()) recorder_->go_on_with(problem.before->heading);
    asking_.past = [this](double t, Side side) { return recorder_->history()->at(t, side); };
    set_pace();
    frames_.emplace(mechanics_, problem.longest, pace_.longest);
    conditions_.emplace(mechanics_, asking_.told, now_.t.hi, pace_.unit);
    solver_.emplace(mechanics_, problem.tolerance, pace_.longest, problem.step, problem.pair);
    if (problem.before != nullptr) solver_->know(problem.before->floor);
    balances_.emplace(mechanics_, *conditions_, *solver_);
}

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

// ---- the loop

void Engine::begin() {
    now_.after_break = mechanics_.next_break(std::nextafter(now_.t.hi, -model::never)) == now_.t.hi;
    find_belt_slopes({});
    std::vector<std::string> names;
    if (problem_.system.named) {
        for (const char* kind : {"theta.", "velocity."}) {
            for (const model::Body& body : problem_.system.bodies) names.push_back(kind + body.name);
        }
    } else {
        names = {"theta", "velocity"};
    }
    for (const model::OwnState& state : problem_.drive.states) names.push_back(state.name);
    if (problem_.before == nullptr) {
        mechanics_.for_each_signal([&](Signal& s) { s.begin(now_.here(), names); });
        bool good = true;
        mechanics_.for_each_signal([&](Signal& s) { good = good && s.arrive(now_.here()); });
        if (!good) fail(Outcome::excitation_not_finite);
        breaks_.echo(now_.t.hi, 1);
        open_and_close();
        press_stops();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!now_.rubs(j)) continue;
            const double s = now_.slip(mechanics_, j);
            const bool weighted = problem_.system.joints[j].is_weighted();
            if (std::fabs(s) > (weighted ? 4 * rounding * mechanics_.speed_scale(j, now_.y) : 0)) {
                contacts_.slide(mechanics_, now_, j, model::motion_of(s), false);
            } else {
                now_.mode.friction[j].way = Motion::stuck;
            }
        }
        touch_walls();
        if (outcome_ == Outcome::reached_end) decide(false);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) contacts_.of[j].leaned = now_.mode.leans[j] != 0;
    } else {
        project(now_.side());
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (now_.mode.friction[j].creeps == Motion::stuck) continue;
            recorder_->creeps(j, event_at(mechanics_, now_, EventKind::stick, j));
        }
        if (now_.after_break) ask_after_break();
    }
    result_.begun = now_.mode;
    result_.initial = now_.y;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) walls_.reach[j] = std::fabs(mechanics_.angle(j, now_.y));
}

void Engine::run() {
    begin();
    unsigned pieces = 0;
    constexpr unsigned between_questions = 16;
    bool alive = outcome_ == Outcome::reached_end;
    while (alive && now_.t.hi < problem_.window.end) {
        if (pieces++ % between_questions == 0 && problem_.monitor && !problem_.monitor(now_.t.hi)) {
            outcome_ = Outcome::interrupted;
            break;
        }
        alive = advance();
    }
    finish();
}

/// One stretch, up to what happens first in it. The order at its end: the state and its rows, controllers, contacts
/// that open or close, what happened, and then the decision of contacts, which reports events. Returns false if the run
/// is over.
bool Engine::advance() {
    if (now_.greatest_of_state() > beyond_all) return fail(Outcome::state_not_finite);
    const Frame& frame = frames_->of(now_.mode);
    if (stands_for_good(frame)) return rest(frame);
    choose(frame);
    if (!(segment_.h > 0)) return fail(Outcome::chattering);
    if (!solve(frame)) return outcome_ == Outcome::reached_end;
    sizes_.find(mechanics_, segment_, now_.here());
    const Ending ending = watch(frame);
    if (outcome_ != Outcome::reached_end) return false;
    if (ending.by == By::condition && ends_before(ending.x)) return true;
    SampledLoads sampled(mechanics_, segment_);
    recorder_->record_turns({now_, segment_, frame, *balances_, sampled}, ending.x, sizes_,
                            solver_->noise().of_torques());
    return end_at(ending.x, frame, sampled) && handle(ending);
}

/// Computes the motion on the stretch. Returns false if another stretch is to be chosen, or the run is over.
bool Engine::solve(const Frame& frame) {
    using Attempt = Collocation::Attempt;
    const std::vector<double>& departing = now_.departing(problem_.system, departing_);
    conditions_->decide({now_.t.hi, now_.side(), departing}, now_.mode, segment_);
    segment_.low = now_.low;
    const Attempt attempt = solver_->solve(segment_, now_.mode, frame, now_.y, departing);
    const bool resolved = attempt == Attempt::resolved;
    if (problem_.step > 0 && resolved && mechanics_.has_belts() && belt_jump_found()) return false;
    const double late = std::max(std::fabs(now_.t.hi), std::fabs(segment_.end));
    const bool short_of_seen = 2 * segment_.h <= std::max(shortest * pace_.unit, 16 * rounding * late);
    if (attempt == Attempt::shorten && !solver_->tells_rests() && short_of_seen) {
        if (chatter_.too_many_short()) return fail(Outcome::chattering);
        solver_->pass_over(segment_);
        solver_->find_limits(segment_, now_.mode);
        pace_.h = 64 * segment_.h;
        return true;
    }
    if (!resolved) {
        again(attempt);
        return false;
    }
    chatter_.stretch_of(2 * segment_.h);
    const double least = segment_.h < short_part * frame.longest ? 2 : 0;
    const double factor = problem_.step > 0
                              ? frame.longest / segment_.h
                              : std::clamp(0.9 * solver_->growth(), least, conditions_->samples() ? 2.0 : 8.0);
    pace_.lengthen(segment_.h, factor, frame.longest);
    return true;
}

void Engine::choose(const Frame& frame) {
    double breaks = std::min(mechanics_.next_break(now_.t.hi), breaks_.next());
    for (const model::WantedEvent& event : problem_.drive.events) {
        breaks = std::min(breaks, event.when->next_break(now_.t.hi));
    }
    double limit = std::min(problem_.window.end, breaks);
    if (problem_.step > 0) {
        // A break that rounding puts beside a step's end is that end.
        const double beside = std::max(1e-9 * problem_.step, 4 * rounding * std::fabs(now_.t.hi));
        const double steps = std::floor((now_.t.hi - problem_.window.start + beside) / problem_.step) + 1;
        const double step_end = problem_.window.start + steps * problem_.step;
        if (step_end < limit - beside) limit = step_end;
    }
    double h = std::min({rung(pace_.h, frame.longest / 2), mechanics_.view(now_.t.hi, cheb::widest_gap) / 2,
                         breaks_.shortest_delay() / 2 * (1 - 1e-12)});
    if (pace_.bad_time < model::never) h = std::min(h, now_.t.until(pace_.bad_time) / 4);
    if (problem_.step == 0) h = std::min(h, longest_under_friction(frame) / 2);
    // As long as it takes to a wall, or back to it, and a little more: a small bounce is to be seen.
    if (walls_.any) h = std::min(h, std::max(0.6 * until_wall(frame), 1e-9 * pace_.unit));
    const double remaining = now_.t.until(limit);
    const bool to_limit = remaining <= 2 * h * (1 + 1e-9);
    segment_.start = now_.t;
    segment_.h = to_limit ? remaining / 2 : remaining < 4 * h ? remaining / 4 : h;
    segment_.end = to_limit ? limit : now_.t.after(2 * segment_.h);
    segment_.from_break = now_.after_break;
    segment_.to_break = to_limit && limit == breaks;
    segment_.to_the_end = to_limit && (segment_.to_break || limit == problem_.window.end || problem_.step == 0);
}

/// Returns the time to the next wall, if all accelerations stay as they are.
double Engine::until_wall(const Frame& frame) {
    double first = model::never;
    if (!balances_->at_present(now_, frame, segment_, balance_)) return first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Walls* walls = joint.any_walls();
        if (walls == nullptr || now_.mode.holds(j) || now_.mode.presses[j] != 0) continue;
        const double rate = joint.sum(balance_.accelerations);
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

/// Returns the length of a stretch under laws of friction that bend with the speed.
double Engine::longest_under_friction(const Frame& frame) {
    double longest = model::never;
    bool looked = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        const model::Friction& law = joint.friction.law;
        const Slipping& how = now_.mode.friction[j];
        if (law.ranges() == 0 || how.way == Motion::stuck || how.riding || now_.mode.leans[j] != 0) continue;
        if (!looked && !balances_->at_present(now_, frame, segment_, balance_)) return longest;
        looked = true;
        const double sign = model::sign_of(how.way);
        const double lightness = joint.lightness(problem_.system.bodies), first = joint.sum(balance_.accelerations);
        const double C = joint.damping, v = mechanics_.velocity(j, now_.y);
        const double second = (std::fabs(joint.stiffness * v) + std::fabs(C * first)) * lightness;
        longest =
            std::min(longest, longest_step(law, law.range(how.range), std::max(0.0, sign * now_.slip(mechanics_, j)),
                                           sign * first, second, C, 1 / lightness));
    }
    return longest;
}

void Engine::again(Collocation::Attempt attempt) {
    const int most = conditions_->samples() ? most_attempts_sampled : most_attempts;
    if (chatter_.too_many_attempts(now_.t.hi, most)) {
        fail(conditions_->samples() ? Outcome::chattering : Outcome::unresolved);
        return;
    }
    if (attempt == Collocation::Attempt::failed) {
        pace_.bad_time = solver_->bad_time();
        const double near = std::max(near_failure * pace_.unit, 64 * rounding * std::fabs(now_.t.hi));
        if (problem_.step > 0 || now_.t.until(pace_.bad_time) <= near || !mechanics_.may_go_on())
            fail(now_.greatest_of_state() > huge ? Outcome::state_not_finite : Outcome::excitation_not_finite);
        pace_.h = segment_.h / 2;
        return;
    }
    if (solver_->found_noise(segment_, now_.mode)) return;
    if (!breaks_.many() && pace_.may_search(now_.t.hi, segment_.h)) {
        const auto found = solver_->found_break(segment_);
        if (found && *found > now_.t.hi && breaks_.add(*found)) {
            if (a_belt_jumps_at(*found)) mechanics_.jumps_at(*found);
            return;
        }
    }
    pace_.shorten(segment_.h, solver_->unresolved(), frames_->of(now_.mode).longest);
}

bool Engine::a_belt_jumps_at(double t) const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (solver_->belt_jumps(segment_, j, t)) return true;
    }
    return false;
}

/// On a step, of which nobody asks whether it was resolved.
bool Engine::belt_jump_found() {
    std::optional<double> first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const auto found = solver_->jump_of_belt(segment_, j);
        if (found && (!first || *found < *first)) first = found;
    }
    if (!first) return false;
    constexpr double right_behind = 1e-6;
    if (now_.t.until(*first) < right_behind * segment_.h) {  // it is behind this moment, and was before it
        if (now_.after_break) return false;
        now_.after_break = true;
        mechanics_.jumps_at(now_.t.hi);
        find_belt_slopes({});
        restart_contacts(Because::belt);
        return true;
    }
    if (!breaks_.add(*first)) return false;
    mechanics_.jumps_at(*first);
    return true;
}

/// Returns whether nothing that may still come moves any body.
bool Engine::stands_for_good(const Frame& present) {
    if (present.groups() > 0 || !present.closing.empty() || mechanics_.states() > 0 || mechanics_.has_base())
        return false;
    if (mechanics_.has_belts() || !problem_.drive.events.empty()) return false;
    bool constant = true;
    mechanics_.for_each_signal([&](const Signal& s) { constant = constant && s.constant_from() <= now_.t.hi; });
    std::vector<double> greatest_pull(mechanics_.joints()), lacking(n()), held(mechanics_.joints());
    std::vector<double> none(mechanics_.joints()), torques;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.is_native(j) || now_.mode.friction[j].riding) return false;
        if (!constant && (now_.mode.leans[j] != 0 || now_.mode.friction[j].creeps != Motion::stuck)) return false;
    }
    if (constant) return true;
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const double most = mechanics_.loads()[i].most();
        if (!(most < model::never)) return false;
        lacking.assign(n(), 0);
        for (const auto& [body, by] : problem_.system.joints[i].of) lacking[body] = by;
        present.multipliers(lacking, held);
        for (std::size_t j = 0; j < held.size(); ++j) greatest_pull[j] += most * std::fabs(held[j]);
    }
    mechanics_.torques(now_.here(), now_.mode, std::vector<double>(mechanics_.joints()), none, torques);
    for (std::size_t i = 0; i < n(); ++i) lacking[i] = -torques[i];
    present.multipliers(lacking, held);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.mode.holds(j) || now_.mode.rigid[j] != 0) continue;
        if (!(greatest_pull[j] - held[j] <= mechanics_.holding(j, Motion::forward, now_.here()))) return false;
        if (!(greatest_pull[j] + held[j] <= mechanics_.holding(j, Motion::backward, now_.here()))) return false;
    }
    return true;
}

/// There is nothing to compute but the loads at the rows, of which there may be many.
bool Engine::rest(const Frame& present) {
    constexpr std::size_t rows_at_once = 1U << 12U;
    const bool many = problem_.rows.count() - recorder_->next_row() > rows_at_once;
    segment_.start = now_.t;
    segment_.end = many ? problem_.rows.time(recorder_->next_row() + rows_at_once) : problem_.window.end;
    segment_.h = now_.t.until(segment_.end) / 2;
    segment_.from_break = segment_.to_break = false, segment_.to_the_end = true;
    solver_->stand_still(segment_, now_.y);
    SampledLoads sampled(mechanics_, segment_);
    return end_at(1, present, sampled);
}

/// Searches the stretch for what happens first.
Ending Engine::watch(const Frame& frame) {
    const Guards::Of of{mechanics_, segment_, frame,      now_,      walls_,
                        sizes_,     *solver_, *balances_, contacts_, normal_halves_};
    Guards guards(of);
    Ending ending = guards.first();
    if (!guards.good()) fail(Outcome::excitation_not_finite);
    for (const std::size_t joint : guards.stay()) hold_again(joint, sizes_.on(joint_at(joint)));
    if (conditions_->any()) conditions_->watch(segment_, now_.y, now_.t.hi, ending);
    const UserEvents::Seen seen = users_.watch(segment_, ending);
    if (!seen.good) fail(Outcome::excitation_not_finite);
    if (seen.again) {
        if (!recorder_->told_user_at(now_.t.hi)) recorder_->tell_user(now_, *seen.again);
        fail(Outcome::chattering);
    }
    if (ending.x > -1 && ending.x < 1 && segment_.time(ending.x) >= segment_.end) ending.x = 1;
    return ending;
}

/// A joint was let go and does not leave: its slip is no event, and it must be pulled clearly farther.
void Engine::hold_again(std::size_t joint, double torques) {
    recorder_->take_back_slip(joint, now_.t.hi);
    Slipping& how = now_.mode.friction[joint];
    how.way = Motion::stuck, how.leaving = false;
    how.blunt = std::max(2 * how.blunt, 64 * rounding * torques);
    if (chatter_.too_often(now_.t.hi) || how.blunt > most_blunt * torques) fail(Outcome::chattering);
}

/// Something that is sampled may jump along with a condition, as a limit that two functions share: then the stretch is
/// made again, up to there.
bool Engine::ends_before(double x) {
    constexpr double beside_end = 1e-6;
    if (!conditions_->samples() || 1 + x < beside_end || 1 - x < beside_end) return false;
    const double t = segment_.time(x), nothing = 64 * rounding * std::fabs(t);
    if (t - now_.t.hi <= nothing || segment_.end - t <= nothing) return false;
    breaks_.add(t);
    conditions_->crosses_at(t);
    return true;
}

/// The stretch ends at x: its rows, and the present.
bool Engine::end_at(double x, const Frame& frame, SampledLoads& sampled) {
    const bool whole = x >= 1;
    const double length = whole ? 2 * segment_.h : segment_.h * (1 + x);
    const Recorder::Stretch stretch{now_, segment_, frame, *balances_, sampled};
    if (!recorder_->rows_until(stretch, whole ? segment_.end : segment_.start.later(length).hi, whole)) {
        return fail(Outcome::excitation_not_finite);
    }
    recorder_->keep(now_, segment_, length, breaks_.longest_delay());
    const double between = std::min(length, solver_->gap(segment_));
    if (mechanics_.has_functions()) result_.gap = std::max(result_.gap, between);
    if (!segment_.proven) result_.unproven = std::max(result_.unproven, problem_.step > 0 ? between : length);
    return arrive(x, whole);
}

/// The present is at x of the stretch: the state, breaks that are behind, controllers, and contacts that open or close.
bool Engine::arrive(double x, bool whole) {
    const double length = whole ? 2 * segment_.h : segment_.h * (1 + x);
    if (x > -1) go_to(x);
    now_.t = whole && segment_.to_the_end ? Clock{segment_.end, 0} : segment_.start.later(length);
    now_.after_break = whole && segment_.to_break && now_.t.hi < problem_.window.end;
    if (now_.after_break) conditions_->pass_break(now_.t.hi);
    mechanics_.forget_jumps(now_.t.hi);
    if (pace_.bad_time <= now_.t.hi) pace_.bad_time = model::never, mechanics_.forget_failure();
    breaks_.pass(now_.t.hi, problem_.window.end);
    if (length > 0) {
        for (Slipping& how : now_.mode.friction) how.leaving = false;
        if (whole) {
            for (Slipping& how : now_.mode.friction) how.blunt = 0;
        }
        for (Contacts::Of& each : contacts_.of) each.edge = 0, each.leaves_wall = false;
    }
    const bool echoed = breaks_.pass_echoes(now_.t.hi);
    if (!whole || (now_.after_break && !echoed)) breaks_.echo(now_.t.hi, 1);
    find_belt_slopes(now_.after_break ? std::nullopt : std::optional(x));
    project(now_.after_break ? Side::before : Side::at);
    bool good = true;
    mechanics_.for_each_signal([&](Signal& s) { good = good && s.arrive(now_.here()); });
    if (!good) return fail(Outcome::excitation_not_finite);
    const bool changed = open_and_close();
    if (now_.after_break) return ask_after_break();
    return !changed || (decide(true) && goes_on());
}

/// Loads, limits and belts may have jumped: what holds is asked again.
bool Engine::ask_after_break() {
    if (!mechanics_.has_belts()) return decide(true);
    // A body that is moved with a new velocity at once throws all that is rigidly linked to it.
    const std::vector<double> before = now_.y;
    const double energy = kinetic_energy();
    if (problem_.hidden > 0) project(now_.side());
    for (std::size_t j = told_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = moved_body(j);
        const double v = now_.y[n() + body], jump = v - before[n() + body];
        if (!(std::fabs(jump) > 64 * rounding * (std::fabs(v) + std::fabs(before[n() + body])))) continue;
        recorder_->add_jump(now_.t.hi, body, {.input = kinetic_energy() - energy});
        recorder_->head(body, v);
        conditions_->forget();
        tell(EventKind::impact, body);
        break;
    }
    return restart_contacts(Because::belt);
}

double Engine::kinetic_energy() const {
    double sum = 0;
    for (std::size_t i = 0; i < n() && problem_.hidden > 0; ++i) {
        sum += mechanics_.own_inertia(i) * now_.y[n() + i] * now_.y[n() + i] / 2;
    }
    return sum;
}

/// The present is at x of the stretch. What is rounded off the angles is kept: beside a wall it is seen.
void Engine::go_to(double x) {
    const std::vector<double> begin = now_.y;
    segment_.state(x, now_.y);
    for (std::size_t i = 0; i < n(); ++i) {
        const double moved =
            (x >= 1 ? segment_.moved[i][node_count - 1] : cheb::value(segment_.series[i], x)) + now_.low[i];
        now_.y[i] = begin[i] + moved;
        const double added = now_.y[i] - begin[i];
        now_.low[i] = (begin[i] - (now_.y[i] - added)) + (moved - added);
    }
    walls_.follow(problem_.system, now_);
}

/// At x of the last stretch; at a break from the right, where nothing tells them but the belts.
void Engine::find_belt_slopes(std::optional<double> x) {
    now_.belt_slopes.assign(mechanics_.joints(), {0, 0});
    for (std::size_t j = 0; mechanics_.has_belts() && j < now_.belt_slopes.size(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        now_.belt_slopes[j] = x ? BeltSlope{cheb::value(cheb::fit(segment_.belt_rates[j]), *x),
                                            solver_->blurred_by_belts(segment_) / balances_->inertia()}
                                : mechanics_.belt_slope(j, towards(now_.t.hi, now_.side()), belt_stretch * pace_.unit);
    }
}

std::vector<std::string> column_names_of(const model::System& system, const model::Drive& drive) {
    std::vector<std::string> names{"t"};
    const auto add = [&](const std::string& joint, std::initializer_list<const char*> columns) {
        for (const char* column : columns) names.push_back(joint.empty() ? column : joint + "." + column);
    };
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        const std::string& name = system.joints[j].name;
        system.is_link(j) ? add(name, {"theta", "velocity", "torque", "friction"})
                          : add(name, {"theta", "velocity", "M", "friction", "damping", "acceleration"});
    }
    for (const model::Body& body : system.bodies) {
        if (body.moved) add(body.name, {"torque"});
    }
    for (const model::OwnState& state : drive.states) names.push_back(state.name);
    return names;
}

Run run_plain(const Request& problem) {
    Run result;
    if (!problem.system.has_moved()) {
        Engine engine(problem, result);
        engine.run();
        return result;
    }
    const double run = problem.window.end - problem.window.start;
    const Moving moving(
        problem.system, problem.drive, problem.window.start,
        std::min({problem.longest, run / 32, longest_in_periods * problem.system.shortest_natural_period()}));
    Request held = problem.on(moving.system, moving.drive);
    held.hidden = moving.system.joints.size() - problem.system.joints.size();
    Engine engine(held, result);
    engine.run();
    result.gap = std::max(result.gap, moving.gap());
    result.unproven = std::max(result.unproven, moving.gap());
    return result;
}

Run run(const Request& problem) {
    const std::size_t own = problem.drive.states.size();
    Witnesses witnesses(problem.system.named ? 2 * problem.system.bodies.size() + own : own);
    model::System system = problem.system;
    const auto of = [&](const char* what, std::size_t joint) {
        return system.named ? fmt::format("{}.{}", what, system.joints[joint].name) : std::string(what);
    };
    const model::Drive drive = witnesses.heard(problem.drive, of);
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (auto& moved = system.bodies[i].moved) {
            moved->motion = witnesses.heard(moved->motion, of(moved->by_angle ? "theta" : "velocity", i));
        }
    }
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        model::Joint& joint = system.joints[j];
        for (auto& sliding : joint.friction.sliding) {
            if (sliding) sliding = witnesses.heard(*sliding, of("Rd", j));
        }
        for (auto& holding : joint.friction.holding) {
            if (holding) holding = witnesses.heard(*holding, of("Re", j));
        }
        if (joint.friction.normal) joint.friction.normal = witnesses.heard(*joint.friction.normal, of("normal", j));
        if (joint.friction.function != nullptr) {
            joint.friction.function = witnesses.heard(joint.friction.function, of("friction", j), "t", 1);
        }
        if (const auto* spring = joint.spring.as<model::springs::UserSpring>()) {
            joint.spring = model::springs::UserSpring{witnesses.heard(spring->function, of("spring", j), "theta")};
        }
    }
    Run result = run_plain(problem.on(system, drive));
    const bool whole = model::is_whole(result.outcome) || result.outcome == Outcome::stopped;
    result.contradiction = witnesses.verdict(whole);
    if (result.contradiction) result.outcome = Outcome::not_a_function;
    return result;
}

}  // namespace dinal::motion::engine
