#include <algorithm>
#include <cmath>

#include "motion/engine/engine.hpp"

namespace dinal::motion::engine {

using model::EventKind;
using model::Joint;
using model::Motion;
using model::Outcome;

bool Engine::handle(const Ending& ending) {
    const std::size_t j = ending.which;
    switch (ending.by) {
        case By::nobody:
            return true;
        case By::kink:
            if (ending.side != 0) contacts_.of[j].load_sign = ending.side;
            return goes_on();
        case By::bend:
            contacts_.of[j].bristle_sign = ending.side;
            return goes_on();
        case By::stays:
            return decide(true);
        case By::slip:
            return come_to_a_stop(j);
        case By::release:
            return release(ending);
        case By::wall:
            return hit(j, ending.side);
        case By::stop:
            return meet_stop(ending);
        case By::slider:
            return turn_slider(ending);
        case By::corner: {
            Slipping& how = now_.mode.friction[j];
            how.range = ending.side > 0 ? how.range + 1 : how.range - 1;
            contacts_.of[j].edge = -ending.side;
            return goes_on();
        }
        case By::condition:
            return cross(ending);
        case By::relay:
            mechanics_.loads()[j].toggle(index(ending.side));
            report_event(EventKind::switched, j);
            return decide(true) && goes_on();
        case By::user:
            return act_all(ending.users);
    }
    return true;
}

/// Handles a change of conditions in functions that are read.
bool Engine::cross(const Ending& ending) {
    pace_.resume_length();
    const Conditions::Crossed crossed = conditions_->cross(ending, now_, chatter_);
    result_.jumps += crossed.count;
    // A motion that crosses a condition again and again does so at similar intervals.
    constexpr double few = 2;
    if (const double half = few * crossed.since; half < pace_.h) pace_.make_again(half, pace_.h);
    if (crossed.work != 0)
        recorder_->add_jump(now_.t.hi, crossed.changes.slides.front().joint.value_or(0), {.input = crossed.work});
    for (const SlideChange& change : crossed.changes.slides) recorder_->report_slide(now_, change);
    bool goes_on = !crossed.endless || !crossed.jumps;
    if (crossed.back && settle(*crossed.back) != Settles::no) {
        goes_on = true;
    } else if (const auto held = crossed.back ? conditions_->hold(*crossed.back, now_) : std::nullopt) {
        const std::vector<SlideChange>& begun = held->changes.slides;
        recorder_->add_jump(now_.t.hi, begun.front().joint.value_or(0), {.input = held->work});
        for (const SlideChange& change : begun) recorder_->report_slide(now_, change);
        return restart_contacts(Because::impact);
    }
    if (!goes_on) return fail(Outcome::chattering);
    // Crossing a condition may make a normal load or a limit 0, or nonzero.
    const bool changed = open_and_close();
    // Contacts stay as they are if no function jumps.
    return changed || crossed.jumps || !crossed.changes.slides.empty() ? decide(true) : true;
}

/// Handles a slip that has reached 0, or passed it because the belt jumped.
bool Engine::come_to_a_stop(std::size_t j) {
    double fastest = std::fabs(mechanics_.belt(j, now_.t.hi, now_.side())) + greatest(segment_.belts[j]);
    for (const auto& [body, by] : joint_at(j).of) fastest += std::fabs(by) * greatest(segment_.y[n() + body]);
    // A slip that passed zero because the belt jumped is not a standstill.
    constexpr double clearly = 1e-6;
    if (mechanics_.has_belt(j) && std::fabs(now_.slip(mechanics_, j)) > clearly * fastest && now_.mode.leans[j] == 0) {
        return restart_contacts(Because::belt) && goes_on();
    }
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const Slipping& how = now_.mode.friction[i];
        if (!now_.rubs(i) || how.way == Motion::stuck || how.riding || now_.mode.leans[i] != 0) continue;
        const model::Weight& first = problem_.system.joints[i].of.front();
        const double size = std::max(fastest, std::fabs(first.by) * greatest(segment_.y[n() + first.body]));
        if (i == j || std::fabs(now_.slip(mechanics_, i)) <= 64 * rounding * size) contacts_.of[i].arrived = how.way;
    }
    if (now_.mode.leans[j] != 0) {  // the belt reverses under a mass at a wall
        contacts_.slide(mechanics_, now_, j,
                        now_.mode.friction[j].way == Motion::forward ? Motion::backward : Motion::forward, true);
        contacts_.of[j].arrived = Motion::stuck;
    }
    return decide(true) && goes_on();
}

/// Handles a joint that has reached its limit.
bool Engine::release(const Ending& ending) {
    const std::size_t j = ending.which;
    std::vector<int>& leant = scratch_.leant;
    std::vector<Slipping>& slid = scratch_.slid;
    leant = now_.mode.leans, slid = now_.mode.friction;
    if (!decide(true, Cause::Released{j, static_cast<Motion>(ending.side)})) return false;
    if (!begun()) recorder_->begin_released(now_.mode);
    bool same = now_.mode.leans == leant;
    for (std::size_t i = 0; i < mechanics_.joints() && same; ++i) {
        const Slipping &is = now_.mode.friction[i], &was = slid[i];
        same = is.way == was.way && is.riding == was.riding && is.creeps == was.creeps;
    }
    // A joint that only touched its limit must exceed it clearly next time.
    if (same && Chatter::raise_margin(now_.mode.friction[j], torque_size(j))) return fail(Outcome::chattering);
    return goes_on();
}

/// Handles the beginning or end of contact with an elastic wall.
bool Engine::meet_stop(const Ending& ending) {
    const std::size_t j = ending.which;
    const model::Walls& stops = *problem_.system.joints[j].stops;
    const int side = ending.side != 0 ? ending.side : now_.mode.presses[j];
    walls_.struck(j, stops.at(side));
    const bool there =
        std::fabs(now_.gap(problem_.system.joints[j], walls_.origin[j])) <= 64 * rounding * std::fabs(walls_.origin[j]);
    contacts_.of[j].leaves_wall = ending.side == 0 && there;
    press(j, ending.side);
    breaks_.echo(now_.t.hi, 1);
    return decide(true) && goes_on();
}

bool Engine::turn_slider(const Ending& ending) {
    const std::size_t j = ending.which;
    if (static_cast<Motion>(ending.side) == Motion::stuck) {
        // The remaining slip and excess of the spring are rounding: without this the slider would slide again at
        // once.
        const Mechanics::Slider& own = mechanics_.sliders()[j];
        const model::Weight& first = problem_.system.joints[own.joint].of.front();
        now_.y[n() + first.body] -= now_.slip(mechanics_, own.joint) / first.by;
        now_.y[own.bend] *= 1 - 8 * rounding;
    }
    let_slide(j, static_cast<Motion>(ending.side));
    return decide(true) && goes_on();
}

/// Applies the decision about contacts and reports it.
bool Engine::decide(bool reports, std::optional<Cause::Released> released) {
    const Evaluation by{mechanics_, *frames_, *balances_, projection_, conditions_->slides(),
                        segment_,   room_,    pace_.unit};
    const Cause cause{released, reports && begun()};
    Decision made = engine::decide(by, std::move(now_), std::move(contacts_), cause);
    now_ = std::move(made.now), contacts_ = std::move(made.contacts);
    for (const Reported& each : made.reported) recorder_->report_event(each);
    room_.reported = std::move(made.reported);
    return made.good || fail(Outcome::excitation_not_finite);
}

/// Returns whether the normal load is zero or negative now and slightly later. A load that only touches zero, or is not
/// finite, opens nothing.
bool Engine::nothing_presses(std::size_t joint) const {
    constexpr double later = 1e-9;
    // At its zero the load may still be positive by rounding.
    if (contacts_.of[joint].load_sign >= 0 && !(mechanics_.pressing(joint, now_.here()) <= 0)) return false;
    std::vector<double> y = now_.y;
    const double h = later * pace_.unit;
    for (std::size_t i = 0; i < n(); ++i) y[i] += h * y[n() + i];
    return mechanics_.pressing(joint, {now_.t.hi + h, Side::at, y}) <= 0;
}

/// Opens contacts that nothing presses together, which then neither stick nor slip, and closes others. Returns whether
/// any has changed.
bool Engine::open_and_close() {
    bool changed = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!mechanics_.may_open(j)) continue;
        const bool opens = nothing_presses(j);
        if (opens != now_.rubs(j)) continue;
        changed = true;
        now_.mode.rubs[j] = opens ? 0 : 1;
        now_.mode.friction[j] = {};
        contacts_.of[j].arrived = Motion::stuck;
        contacts_.of[j].load_sign = opens ? -1 : 1;
        const Joint& joint = problem_.system.joints[j];
        double fastest = std::fabs(mechanics_.belt(j, now_.t.hi, now_.side()));
        for (const auto& [body, by] : joint.of) {
            const double v = now_.y[n() + body];
            fastest = std::max(fastest, std::fabs(by * v));
            if (opens) recorder_->set_heading(body, v);
        }
        if (!opens && std::fabs(now_.slip(mechanics_, j)) > 16 * rounding * fastest) {
            contacts_.slide(mechanics_, now_, j, model::motion_of(now_.slip(mechanics_, j)), false);
        } else if (!opens && now_.mode.leans[j] == 0) {
            // so that a stick is reported if it sticks from now on
            contacts_.slide(mechanics_, now_, j, Motion::forward, true);
        }
        if (begun()) report_event(opens ? EventKind::opened : EventKind::closed, j);
    }
    return changed;
}

/// Updates all contacts after a jump of velocities, caused by an impact at the joint `at`, a user's action or a belt.
bool Engine::restart_contacts(Because why, std::size_t at) {
    open_and_close();
    const std::vector<double> caught = catch_freewheels(false);
    press_stops();
    turn_sliders();
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        restart_contact(j, why, at, caught.empty() ? 0 : caught[j]);
    }
    return decide(true);
}

void Engine::restart_contact(std::size_t j, Because why, std::size_t at, double caught) {
    if (!now_.rubs(j) || now_.mode.leans[j] != 0) return;
    Slipping& how = now_.mode.friction[j];
    const double s = now_.slip(mechanics_, j);
    const double corner = std::max(rounding_of_slip(j, why), caught);
    if (std::fabs(s) <= corner) {
        if (how.way == Motion::stuck || how.riding) return;
        if (why == Because::act) {
            how.leaving = true;  // a joint stopped by a user's action did not come to rest by itself
        } else {
            contacts_.of[j].arrived = how.way;
        }
        return;
    }
    const Motion way = model::motion_of(s);
    const bool held = how.way == Motion::stuck || how.riding;
    how.leaving = false;
    if (held || how.way != way) {
        const bool reports = why == Because::belt ? begun() : why == Because::impact && j != at;
        if (held && reports) report_event(EventKind::slip, j);
        if (!held && why == Because::belt) report_event(EventKind::turn, j);
        contacts_.slide(mechanics_, now_, j, way, false);
    } else if (const model::Friction& law = problem_.system.joints[j].friction.law; law.ranges() > 0) {
        const model::SpeedRange range = law.range(how.range);  // the speed may have jumped out of the range
        const double speed = std::fabs(s);
        if (speed < range.from - corner || speed > range.to + corner) contacts_.slide(mechanics_, now_, j, way, false);
    }
}

/// Returns the slip up to which a joint counts as at rest after a jump of velocities.
double Engine::rounding_of_slip(std::size_t j, Because why) const {
    const double belt = mechanics_.belt(j, now_.t.hi, now_.side());
    const bool weighted = problem_.system.joints[j].is_weighted();
    const double known = weighted ? mechanics_.speed_scale(j, now_.y) : std::fabs(mechanics_.velocity(j, now_.y));
    double corner = 4 * rounding * (known + std::fabs(belt));
    if (why == Because::belt && mechanics_.has_belt(j)) {
        // If the belt has only a corner, its values on both sides differ by rounding and by its change over the tiny
        // time step.
        double rate = std::fabs(now_.belt_slopes[j].rate);
        if (!segment_.belt_rates.empty()) rate = std::max(rate, std::fabs(segment_.belt_rates[j][node_count - 1]));
        corner = 16 * corner + rate * 64 * rounding * std::fabs(now_.t.hi);
    }
    return corner;
}

/// Updates the contact with elastic walls after a jump of the state. Returns whether any has changed.
bool Engine::press_stops() {
    bool changed = false;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const auto& stops = problem_.system.joints[j].stops;
        if (!stops) continue;
        const double q = mechanics_.angle(j, now_.y), v = mechanics_.velocity(j, now_.y);
        int side = 0;
        for (const int wall : {1, -1}) {
            if (!std::isfinite(stops->at(wall))) continue;
            const double nothing = 64 * rounding * std::fabs(stops->at(wall));
            const double depth = wall * (q - stops->at(wall)), torque = wall * stops->torque(wall, q, v);
            const bool before = now_.mode.presses[j] == wall;
            const double least = before ? -nothing : nothing;
            if (depth > least && torque > least * stops->stiffness) side = wall;
        }
        if (side == now_.mode.presses[j]) continue;
        changed = true;
        if (begun()) {
            press(j, side);
        } else {
            now_.mode.presses[j] = side;
        }
    }
    return changed;
}

/// Begins or ends contact with an elastic wall. The energy stored in the wall at the end is lost.
void Engine::press(std::size_t joint, int side) {
    const model::Walls& stops = *problem_.system.joints[joint].stops;
    const int wall = side != 0 ? side : now_.mode.presses[joint];
    const double depth = mechanics_.angle(joint, now_.y) - stops.at(wall);
    const double stored = (side != 0 ? -1 : 1) * stops.stiffness * depth * depth / 2;
    recorder_->add_jump(now_.t.hi, joint, {.impacts = stored, .kept = -stored});
    now_.mode.presses[joint] = side;
    report_event(side != 0 ? EventKind::impact : EventKind::released, joint);
}

void Engine::let_slide(std::size_t slider, Motion way) {
    const Mechanics::Slider& own = mechanics_.sliders()[slider];
    now_.mode.sliders[slider] = way;
    if (way != Motion::stuck) now_.y[own.bend] = model::sign_of(way) * own.limit / own.stiffness;
    report_event(way == Motion::stuck ? EventKind::slider_sticks : EventKind::slider_slips, own.joint);
}

/// Makes sliders stick whose slip has reversed in a jump of velocities. Returns whether there were any.
bool Engine::turn_sliders() {
    bool turned = false;
    for (std::size_t s = 0; s < now_.mode.sliders.size(); ++s) {
        const double way = model::sign_of(now_.mode.sliders[s]);
        const std::size_t joint = mechanics_.sliders()[s].joint;
        if (!(way * now_.slip(mechanics_, joint) < -16 * rounding * mechanics_.speed_scale(joint, now_.y))) continue;
        let_slide(s, Motion::stuck);
        turned = true;
    }
    return turned;
}

/// Stops freewheels that are thrown backward and joints that are thrown into the wall on which they lean, the fastest
/// first. If a joint is thrown back again, all that have stopped since stop together, as after endlessly many smaller
/// impacts. At the start, the energy of a system with a moved body is counted from after this. Returns the rounding of
/// the slip of each joint; empty if there is no freewheel.
std::vector<double> Engine::catch_freewheels(bool at_start) {
    if (!problem_.system.has_freewheels()) return {};
    const std::size_t joints = mechanics_.joints(), most = 50 * joints;
    std::vector<double> rounded(joints);
    for (std::size_t j = 0; j < joints; ++j) rounded[j] = 16 * rounding * mechanics_.speed_scale(j, now_.y);
    std::vector<char> stopped(joints, 0);
    for (std::size_t k = 0; k < most; ++k) {
        std::size_t worst = joints;
        double least = 0;
        for (std::size_t j = 0; j < joints; ++j) {
            const bool one_way = problem_.system.joints[j].friction.law.is_one_way() && now_.rubs(j);
            if (!one_way && now_.mode.leans[j] == 0) continue;
            const double v = one_way ? now_.slip(mechanics_, j) : -now_.mode.leans[j] * mechanics_.velocity(j, now_.y);
            if (v < -rounded[j] && v < least) worst = j, least = v;
        }
        if (worst == joints) break;
        const Impulses::Thrown thrown = impulses_.along(worst, now_);
        if (!(thrown.lightness > 0)) break;
        double lost = 0;
        if (stopped[worst] != 0) {
            lost = stop_together(stopped);
            stopped.assign(joints, 0);
        } else {
            const double before = mechanics_.velocity(worst, now_.y), energy = kinetic_energy();
            const double after = now_.mode.leans[worst] != 0 ? 0 : mechanics_.belt(worst, now_.t.hi, now_.side());
            Impulses::apply(thrown, after, now_);
            lost = (before - after) * (before + after) / thrown.lightness / 2;
            if (!at_start) add_work_of_moved(worst, energy, lost);
            stopped[worst] = 1;
        }
        if (!at_start || !problem_.system.has_moved()) recorder_->add_jump(now_.t.hi, worst, {.impacts = lost});
    }
    return rounded;
}

/// Changes velocities by the impulses that stop these joints at once. Returns the kinetic energy lost.
double Engine::stop_together(const std::vector<char>& joints) {
    const std::vector<double> before = now_.y;
    Mode held = now_.mode;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        held.friction[j].way = Motion::stuck;
        if (joints[j] == 0) held.rubs[j] = 0, held.leans[j] = 0;
    }
    std::swap(now_.mode, held);
    projection_.apply(now_, Frame(problem_.system, now_.mode), now_.side());
    std::swap(now_.mode, held);
    double lost = 0;
    for (std::size_t i = 0; i < n(); ++i) {
        const double old = before[n() + i], now = now_.y[n() + i];
        if (now != old) lost += mechanics_.own_inertia(i) * (old - now) * (old + now) / 2;
    }
    return lost;
}

/// Makes joints lean that stand at a wall, and marks those at a wall as leaving it.
void Engine::touch_walls() {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const Joint& joint = problem_.system.joints[j];
        if (!joint.walls) continue;
        for (const int wall : {1, -1}) {
            if (mechanics_.angle(j, now_.y) != joint.walls->at(wall)) continue;
            contacts_.of[j].leaves_wall = true;
            if (mechanics_.velocity(j, now_.y) == 0) now_.mode.leans[j] = wall;
        }
    }
}

}  // namespace dinal::motion::engine
