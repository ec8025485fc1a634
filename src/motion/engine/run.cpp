#include "motion/engine/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/springs.hpp"
#include "motion/engine/collocation.hpp"
#include "motion/engine/engine.hpp"
#include "motion/engine/guards.hpp"
#include "motion/engine/moving.hpp"
#include "motion/engine/runge_kutta.hpp"
#include "motion/witness.hpp"

namespace dinal::motion::engine {

namespace {

using model::Event;
using model::EventKind;
using model::Joint;
using model::Motion;
using model::Outcome;

// Relative to the time scale of the motion.
constexpr double shortest = 1e-13;  // shorter times cannot affect the motion
// margin below the overflow of a series' bounds
constexpr double beyond_all = std::numeric_limits<double>::max() / 1e7;

}  // namespace

Engine::Engine(const Request& problem, Run& result)
    : problem_(problem),
      result_(result),
      convention_{.named = problem.system.named,
                  .passed = 2 * problem.system.bodies.size() + problem.drive.states.size()},
      mechanics_(problem.system, problem.drive, convention_),
      now_{.t = {problem.window.start, 0}},
      contacts_{.of = std::vector<Contacts::Contact>(mechanics_.joints())},
      walls_(problem.system),
      breaks_(mechanics_),
      projection_(mechanics_, problem_.own_joints()),
      impulses_(mechanics_),
      users_(mechanics_, problem.drive.events) {
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
        for (std::size_t j = 0; j < joints; ++j) mechanics_.loads()[j].restore(problem.before->controllers[j]);
        breaks_.set_echoes(problem.before->echoes);
        if (!problem.before->watches.empty()) users_.set_watches(problem.before->watches);
    }
    now_.keep_rigid_places(problem_.system);
    set_pace();
    recorder_.emplace(problem, mechanics_, result, now_, pace_.unit);
    if (problem.before != nullptr && !problem.before->heading.empty()) recorder_->set_headings(problem.before->heading);
    convention_.past = [this](double t, Side side) { return recorder_->history()->at(t, side); };
    frames_.emplace(mechanics_, problem.longest, pace_.longest);
    conditions_.emplace(mechanics_, *frames_, convention_.passed, now_.t.hi, pace_.unit);
    if (problem.step > 0 || problem.pair != nullptr) {
        solver_ =
            std::make_unique<RungeKutta>(mechanics_, problem.tolerance, pace_.longest, problem.step, problem.pair);
    } else {
        solver_ = std::make_unique<Collocation>(mechanics_, problem.tolerance, pace_.longest);
    }
    if (problem.before != nullptr) solver_->start_with(problem.before->floor);
    balances_.emplace(mechanics_, *conditions_, *solver_);
    if (problem.step > 0) plain_steps_.emplace(problem, mechanics_);
}

// ---- the loop

void Engine::begin() {
    // The search for the breaks of a formula takes a break within rounding of its start for past.
    constexpr double few = 16, smallest_time = 1e-290;
    const double earlier = now_.t.hi - std::max(few * rounding * std::fabs(now_.t.hi), smallest_time);
    now_.after_break = mechanics_.next_break(earlier) <= now_.t.hi;
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
        if (!sample_controllers()) fail(Outcome::excitation_not_finite);
        breaks_.echo(now_.t.hi, 1);
        open_and_close();
        align_rigid_velocities();
        // From the start a belt or a moved body carries bodies along that a freewheel keeps from falling behind.
        const std::vector<double> caught = catch_freewheels(true);
        press_stops();
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!now_.rubs(j)) continue;
            const double s = now_.slip(mechanics_, j);
            const bool weighted = problem_.system.joints[j].is_weighted();
            const double rounded = weighted ? 4 * rounding * mechanics_.speed_scale(j, now_.y) : 0;
            if (std::fabs(s) > (caught.empty() ? rounded : caught[j])) {
                contacts_.slide(mechanics_, now_, j, model::motion_of(s), false);
            } else {
                now_.mode.friction[j].way = Motion::stuck;
            }
        }
        touch_walls();
        if (conditions_->any()) conditions_->start(now_);
        if (outcome_ == Outcome::reached_end) decide(false);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) contacts_.of[j].leaned = now_.mode.leans[j] != 0;
    } else {
        // Bodies that stick to a belt have its velocity before the break, as at the end of a stretch.
        project(now_.after_break ? Side::before : Side::at);
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (now_.mode.friction[j].creeps == Motion::stuck) continue;
            contacts_.of[j].creeping = event_at(mechanics_, now_, EventKind::stick, j);
        }
        if (now_.after_break) decide_after_break();
    }
    recorder_->begin(now_);
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
    if (alive) handle_events_at_end();
    finish();
}

/// Computes one stretch up to its first event. At its end follow, in this order: state and rows, controllers, opening
/// and closing of contacts, the event itself, and the decision about contacts, which reports events. Returns false if
/// the run is over.
bool Engine::advance() {
    if (now_.greatest_of_state() > beyond_all) return fail(Outcome::state_not_finite);
    const Frame& frame = frames_->of(now_.mode);
    if (stands_for_good(frame)) return rest(frame);
    if (take_plain_steps()) return true;
    choose(frame);
    if (!(segment_.h > 0)) return fail(Outcome::chattering);
    if (!solve(frame)) return outcome_ == Outcome::reached_end;
    if (strays_from_prescribed(frame)) return fail(Outcome::blocked);
    sizes_ = solver_->sizes_at_start();
    if (mechanics_.nonlinear()) sizes_.find(mechanics_, segment_, now_.here());
    const Ending ending = watch(frame);
    if (outcome_ != Outcome::reached_end) return false;
    if (ending.by == By::condition && ends_before(ending.x)) return true;
    if (ending.by != By::nobody && conditions_->any() && repeat_if_early(ending)) return true;
    if (ending.by == By::condition && problem_.step == 0 &&
        !solver_->hides_nothing_until(ending.x, segment_, now_.mode)) {
        retry(Flow::Attempt::shorten);
        return outcome_ == Outcome::reached_end;
    }
    users_.advance(ending.x);
    SampledLoads sampled(mechanics_, segment_);
    recorder_->record_turns({now_, segment_, frame, *balances_, sampled}, ending.x, sizes_,
                            solver_->noise_of_torques(segment_));
    return end_at(ending.x, frame, sampled) && handle(ending);
}

/// Returns whether holding joints keep moved bodies, belts or rigid links from their motion on the stretch, or a
/// freewheel turns backward.
bool Engine::strays_from_prescribed(const Frame& frame) const {
    if (problem_.hidden == 0 && !(mechanics_.has_belts() && problem_.system.has_freewheels())) return false;
    constexpr double clearly = 1e-6;
    std::vector<double> belts(mechanics_.joints()), offsets(n());
    for (const std::size_t node : {node_count / 2, node_count - 1}) {
        for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = now_.mode.holds(j) ? segment_.belts[j][node] : 0;
        frame.offsets(belts, now_.mode, offsets);
        for (std::size_t j = 0; j < belts.size(); ++j) {
            const bool one_way = now_.rubs(j) && joint_at(j).friction.law.is_one_way();
            if (one_way && now_.mode.friction[j].way == Motion::backward) return true;
            if (now_.mode.rigid[j] == 0 && !(one_way && now_.mode.holds(j))) continue;
            const double size = joint_at(j).size(offsets) + std::fabs(belts[j]);
            if (std::fabs(joint_at(j).sum(offsets) - belts[j]) > clearly * size) return true;
        }
    }
    return false;
}

/// Takes steps without events, which need no segment.
bool Engine::take_plain_steps() {
    if (!plain_steps_ || pace_.bad_time < model::never || !plain_steps_->may_begin(now_) || conditions_->slides().any())
        return false;
    const std::vector<double>& departing = now_.departing(problem_.system, scratch_.departing);
    conditions_->decide({now_.t.hi, now_.side(), departing}, now_.mode, segment_);
    if (!plain_steps_->take({now_, departing, contacts_, walls_, users_, *conditions_, *recorder_}, next_break())) {
        return false;
    }
    walls_.follow(problem_.system, now_);
    if (!mechanics_.has_functions()) return true;
    result_.gap = std::max(result_.gap, plain_steps_->gap());
    result_.unproven = std::max(result_.unproven, plain_steps_->gap());
    return true;
}

/// Computes the motion on the stretch. Returns false if another length must be tried, or the run is over.
bool Engine::solve(const Frame& frame) {
    using Attempt = Flow::Attempt;
    const std::vector<double>& departing = now_.departing(problem_.system, scratch_.departing);
    for (const SlideChange& change : conditions_->ceased(now_)) recorder_->report_slide(now_, change);
    conditions_->decide({now_.t.hi, now_.side(), departing}, now_.mode, segment_);
    segment_.low = now_.low;
    const Attempt attempt = solver_->solve(segment_, now_.mode, frame, now_.y, departing);
    const bool resolved = attempt == Attempt::resolved;
    if (problem_.step > 0 && resolved && mechanics_.has_belts() && belt_jump_found()) return false;
    const double late = std::max(std::fabs(now_.t.hi), std::fabs(segment_.end));
    const bool too_short = 2 * segment_.h <= std::max(shortest * pace_.unit, 16 * rounding * late);
    if (attempt == Attempt::shorten && !solver_->takes_rests() && too_short) {
        if (chatter_.too_many_short()) return fail(Outcome::chattering);
        solver_->pass_over(segment_);
        solver_->find_limits(segment_, now_.mode);
        pace_.h = 64 * segment_.h;
        return true;
    }
    if (!resolved) {
        retry(attempt);
        return false;
    }
    chatter_.note_length(2 * segment_.h);
    const double least = segment_.h < short_part * frame.longest ? 2 : 0;
    const double factor = problem_.step > 0
                              ? frame.longest / segment_.h
                              : std::clamp(0.9 * solver_->growth(), least, conditions_->samples() ? 2.0 : 8.0);
    pace_.lengthen(segment_.h, factor, frame.longest);
    return true;
}

bool Engine::a_belt_jumps_at(double t) const {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (solver_->belt_jumps(segment_, j, t)) return true;
    }
    return false;
}

/// Searches a Runge-Kutta step, whose error is not checked, for a jump of a belt.
bool Engine::belt_jump_found() {
    std::optional<double> first;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const auto found = solver_->jump_of_belt(segment_, j);
        if (found && (!first || *found < *first)) first = found;
    }
    if (!first) return false;
    constexpr double right_behind = 1e-6;
    if (now_.t.until(*first) < right_behind * segment_.h) {  // the jump is at the start of the step
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

/// Searches the stretch for its first event.
Ending Engine::watch(const Frame& frame) {
    const Guards::Parts parts{mechanics_, segment_,   frame,     now_,         walls_, sizes_,
                              *solver_,   *balances_, contacts_, *conditions_, users_};
    Guards guards(parts);
    Ending ending = guards.first();
    if (!guards.good()) fail(Outcome::excitation_not_finite);
    for (const std::size_t joint : guards.stay()) hold_again(joint, sizes_.on(joint_at(joint)));
    if (guards.thrown_back()) {
        if (!recorder_->has_user_event_at(now_.t.hi)) recorder_->report_user_event(now_, *guards.thrown_back());
        fail(Outcome::chattering);
    }
    if (ending.x > -1 && ending.x < 1 && segment_.time(ending.x) >= segment_.end) ending.x = 1;
    return ending;
}

/// Makes a joint stick again that was released but did not move: its slip is withdrawn, and it needs a clearly larger
/// pull.
void Engine::hold_again(std::size_t joint, double torques) {
    recorder_->withdraw_slip(joint, now_.t.hi);
    std::erase(contacts_.last_full, joint);
    Slipping& how = now_.mode.friction[joint];
    how.way = Motion::stuck, how.leaving = false;
    if (!goes_on() || Chatter::raise_margin(how, torques)) fail(Outcome::chattering);
}

/// Repeats the stretch up to a condition at x if sampled functions may jump there, too, such as a limit that two
/// functions share.
bool Engine::ends_before(double x) {
    constexpr double beside_end = 1e-6;
    if (!conditions_->samples() || 1 + x < beside_end || 1 - x < beside_end) return false;
    const double t = segment_.time(x), nothing = 64 * rounding * std::fabs(t);
    if (t - now_.t.hi <= nothing || segment_.end - t <= nothing) return false;
    breaks_.add(t);
    conditions_->crosses_at(t);
    return true;
}

/// Repeats a stretch with nearly its useful length if its first event is very early, or if rates extrapolated beyond it
/// dwarf those before. A long extrapolation of a function that acts only in a short window loses the window's end to
/// rounding.
bool Engine::repeat_if_early(const Ending& ending) {
    constexpr double early = 1.0 / 64, least = 1.0 / 1024;
    const double part = 1 + ending.x, late = std::max(std::fabs(now_.t.hi), std::fabs(segment_.end));
    if (problem_.step > 0 || (part <= 0 && !ending.blurred)) return false;
    if (part > early && !(ending.x < 1 && solver_->is_dwarfed_beyond(ending.x, segment_))) return false;
    const double h = segment_.h * (part > early ? part / 2 : std::max(part, least));
    if (2 * h <= std::max(shortest * pace_.unit, 16 * rounding * late)) return false;
    pace_.make_again(h, segment_.h);
    return true;
}

/// Returns whether no body can ever move again.
bool Engine::stands_for_good(const Frame& present) {
    if (present.groups() > 0 || !present.closing.empty() || mechanics_.states() > 0 || mechanics_.has_base())
        return false;
    if (mechanics_.has_belts() || !problem_.drive.events.empty()) return false;
    bool constant = true;
    mechanics_.for_each_signal([&](const Signal& s) { constant = constant && s.constant_from() <= now_.t.hi; });
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.is_native(j) || now_.mode.friction[j].riding) return false;
        if (!constant && (now_.mode.leans[j] != 0 || now_.mode.friction[j].creeps != Motion::stuck)) return false;
    }
    if (constant) return true;
    auto& [greatest_pull, lacking, held, belts, loads, torques] = scratch_.standing;
    greatest_pull.assign(mechanics_.joints(), 0), held.assign(mechanics_.joints(), 0);
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const double most = mechanics_.loads()[i].most();
        if (!(most < model::never)) return false;
        lacking.assign(n(), 0);
        for (const auto& [body, by] : problem_.system.joints[i].of) lacking[body] = by;
        present.multipliers(lacking, held);
        for (std::size_t j = 0; j < held.size(); ++j) greatest_pull[j] += most * std::fabs(held[j]);
    }
    const auto most = [&](std::size_t j, Motion way) { return mechanics_.holding(j, way, now_.here()); };
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.mode.holds(j) || now_.mode.rigid[j] != 0) continue;
        constexpr double clearly = 1 - 1e-9;
        if (2 * clearly * greatest_pull[j] > most(j, Motion::forward) + most(j, Motion::backward)) return false;
    }
    belts.assign(mechanics_.joints(), 0), loads.assign(mechanics_.joints(), 0);
    mechanics_.torques(now_.here(), now_.mode, belts, loads, torques);
    for (std::size_t i = 0; i < n(); ++i) lacking[i] = -torques[i];
    present.multipliers(lacking, held);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now_.mode.holds(j) || now_.mode.rigid[j] != 0) continue;
        if (!(greatest_pull[j] - held[j] <= most(j, Motion::forward))) return false;
        if (!(greatest_pull[j] + held[j] <= most(j, Motion::backward))) return false;
    }
    return true;
}

/// Computes the loads at the rows of a system at rest, in portions if there are many rows.
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

/// Ends the stretch at x: writes its rows and advances the present.
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

/// Advances the present to x of the stretch: state, passed breaks, controllers, and contacts that open or close.
bool Engine::arrive(double x, bool whole) {
    const double length = whole ? 2 * segment_.h : segment_.h * (1 + x);
    if (x > -1) go_to(x);
    now_.t = whole && segment_.to_the_end ? Clock{segment_.end, 0} : segment_.start.later(length);
    const bool at_break = whole && segment_.to_break;
    now_.after_break = at_break && now_.t.hi < problem_.window.end;
    if (now_.after_break) conditions_->pass_break(now_);
    mechanics_.forget_jumps(now_.t.hi);
    if (pace_.bad_time <= now_.t.hi) pace_.bad_time = model::never, mechanics_.forget_failure();
    breaks_.pass(now_.t.hi, problem_.window.end);
    if (length > 0) {
        conditions_->return_to_surfaces(now_);
        for (Slipping& how : now_.mode.friction) how.leaving = false;
        if (whole) {
            for (Slipping& how : now_.mode.friction) how.margin = 0;
        }
        for (Contacts::Contact& each : contacts_.of) each.edge = 0, each.leaves_wall = false;
    }
    const bool echoed = breaks_.pass_echoes(now_.t.hi);
    if (!whole || (now_.after_break && !echoed)) breaks_.echo(now_.t.hi, 1);
    find_belt_slopes(now_.after_break ? std::nullopt : std::optional(x));
    project(at_break ? Side::before : Side::at);
    if (!sample_controllers()) return fail(Outcome::excitation_not_finite);
    const bool changed = open_and_close();
    if (now_.after_break) return decide_after_break();
    return !changed || (decide(true) && goes_on());
}

/// Runs sampled controllers that are due. Returns false if one failed.
bool Engine::sample_controllers() {
    bool samples = false, good = true;
    mechanics_.for_each_signal([&](const Signal& s) { samples = samples || s.has_sampled(); });
    if (!samples) return true;
    mechanics_.call_unread(now_.here(), now_.mode);
    mechanics_.for_each_signal([&](Signal& s) { good = good && s.update_controllers(now_.here()); });
    return good;
}

/// Makes the velocities of rigidly linked bodies agree after a jump. Friction gives no impulse: a body that only sticks
/// to one whose velocity jumps slips.
void Engine::align_rigid_velocities() {
    const std::vector<char>& rigid = now_.mode.rigid;
    if (problem_.hidden == 0 && std::count(rigid.begin(), rigid.end(), 0) == std::ssize(rigid)) return;
    Mode sticking = now_.mode;
    for (std::size_t j = 0; j < problem_.own_joints(); ++j) now_.mode.friction[j].way = Motion::forward;
    project(now_.side());
    now_.mode = std::move(sticking);
}

/// Decides contacts again after a break, at which loads, limits and belts may have jumped.
bool Engine::decide_after_break() {
    if (!mechanics_.has_belts()) return decide(true);
    // A jump of a prescribed velocity throws all bodies that are linked to it rigidly.
    const std::vector<double> before = now_.y;
    const double energy = kinetic_energy();
    align_rigid_velocities();
    for (std::size_t j = problem_.own_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = problem_.moved_body(j);
        const double v = now_.y[n() + body], jump = v - before[n() + body];
        if (!(std::fabs(jump) > 64 * rounding * (std::fabs(v) + std::fabs(before[n() + body])))) continue;
        recorder_->add_jump(now_.t.hi, body, {.input = kinetic_energy() - energy});
        recorder_->set_heading(body, v);
        conditions_->forget();
        report_event(EventKind::impact, body);
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

/// Counts the work of a moved body's impulse at an impact of the joint as input of that body: the change of the kinetic
/// energy from `before`, plus the energy `lost` in the impact.
void Engine::add_work_of_moved(std::size_t joint, double before, double lost) {
    if (problem_.hidden == 0) return;
    const double now = kinetic_energy(), work = now - before + lost;
    if (!(std::fabs(work) > 64 * rounding * (now + before + lost))) return;
    std::size_t body = problem_.moved_body(problem_.own_joints());
    for (std::size_t j = problem_.own_joints(); j < mechanics_.joints(); ++j) {
        if (joint_at(joint).is_on(problem_.moved_body(j))) body = problem_.moved_body(j);
    }
    recorder_->add_jump(now_.t.hi, body, {.input = work});
}

/// Sets the present to x of the stretch. The rounding errors of the angles are kept, as they matter near a wall.
void Engine::go_to(double x) {
    for (std::size_t i = 0; i < n(); ++i) {
        const double moved =
            (x >= 1 ? segment_.moved[i][node_count - 1] : cheb::value(segment_.series[i], x)) + now_.low[i];
        const double begin = now_.y[i];
        now_.y[i] = begin + moved;
        const double added = now_.y[i] - begin;
        now_.low[i] = (begin - (now_.y[i] - added)) + (moved - added);
    }
    for (std::size_t k = n(); k < now_.y.size(); ++k) now_.y[k] = segment_.at(k, x);
    walls_.follow(problem_.system, now_);
}

/// Computes the slopes of belts at x of the last stretch or, at a break (no x), from the belts to the right of it.
void Engine::find_belt_slopes(std::optional<double> x) {
    now_.belt_slopes.assign(mechanics_.joints(), {0, 0});
    for (std::size_t j = 0; mechanics_.has_belts() && j < now_.belt_slopes.size(); ++j) {
        if (!mechanics_.has_belt(j)) continue;
        BeltSlope& slope = now_.belt_slopes[j];
        slope = x ? BeltSlope{cheb::value(cheb::fit(segment_.belt_rates[j]), *x),
                              solver_->blurred_by_belts(segment_) / balances_->inertia()}
                  : mechanics_.belt_slope(j, towards(now_.t.hi, now_.side()), belt_stretch * pace_.unit);
        if (slope.sure() != 0) continue;
        // A belt that turns right now moves on by its curvature.
        constexpr double clearly = 1024 * rounding;
        const double later = mechanics_.after_turn(now_.t.hi, pace_.unit), length = later - now_.t.hi;
        const double v = mechanics_.belt(j, now_.t.hi, now_.side()), then = mechanics_.belt(j, later, Side::at);
        if (length > 0 && std::fabs(then - v) > clearly * std::fabs(then)) slope = {(then - v) / length, 0};
    }
}

std::vector<std::string> column_names_of(const model::System& system, const model::Drive& drive) {
    std::vector<std::string> names{"t"};
    const auto add = [&](const std::string& joint, const ColumnKind& kind) {
        names.push_back((joint.empty() ? "" : joint + ".").append(kind.name));
    };
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        for (const ColumnKind& kind : columns_of(system.is_link(j)).subspan(1)) add(system.joints[j].name, kind);
    }
    for (const model::Body& body : system.bodies) {
        if (body.moved) add(body.name, column::torque);
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
    const model::Drive drive = witnesses.with_witness(problem.drive, of);
    for (std::size_t i = 0; i < system.bodies.size(); ++i) {
        if (auto& moved = system.bodies[i].moved) {
            moved->motion = witnesses.with_witness(moved->motion, of(moved->by_angle ? "theta" : "velocity", i));
        }
    }
    for (std::size_t j = 0; j < system.joints.size(); ++j) {
        model::Joint& joint = system.joints[j];
        for (auto& sliding : joint.friction.sliding) {
            if (sliding) sliding = witnesses.with_witness(*sliding, of("Rd", j));
        }
        for (auto& holding : joint.friction.holding) {
            if (holding) holding = witnesses.with_witness(*holding, of("Re", j));
        }
        if (joint.friction.normal)
            joint.friction.normal = witnesses.with_witness(*joint.friction.normal, of("normal", j));
        if (joint.friction.function != nullptr) {
            joint.friction.function = witnesses.with_witness(joint.friction.function, of("friction", j), "t", 1);
        }
        if (const auto* spring = joint.spring.as<model::springs::UserSpring>()) {
            joint.spring =
                model::springs::UserSpring{witnesses.with_witness(spring->function, of("spring", j), "theta")};
        }
    }
    Run result = run_plain(problem.on(system, drive));
    const bool whole = model::is_whole(result.outcome) || result.outcome == Outcome::stopped;
    result.contradiction = witnesses.verdict(whole);
    if (result.contradiction) result.outcome = Outcome::not_a_function;
    return result;
}

}  // namespace dinal::motion::engine
