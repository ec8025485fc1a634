#include <algorithm>
#include <cmath>

#include "motion/engine/engine.hpp"

namespace dinal::motion::engine {

using model::EventKind;
using model::Joint;
using model::Motion;
using model::Outcome;

namespace {

// Relative to the time scale of the motion.
constexpr double last_bounces = 1e-7, shortest_bounce = 1e-10;
constexpr double faded_impact = 1e-12;  // relative to the fastest impact at the same time

}  // namespace

/// Returns the durations of the next bounce and of all bounces from this speed, under constant torques; empty if a
/// torque is not finite.
std::optional<Engine::Bounces> Engine::next_bounces(std::size_t joint, int wall, double speed) {
    const Joint& own = problem_.system.joints[joint];
    const auto back_in = [&](bool out) {
        Mode thrown = now_.mode;
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            if (!now_.rubs(j)) continue;
            if (now_.slip(mechanics_, j) != 0) thrown.friction[j].way = model::motion_of(now_.slip(mechanics_, j));
            // Friction opposes the sliding: it reverses with the bounce, or, on a belt, keeps its direction.
            const bool turns = j == joint && mechanics_.belt(j, now_.t.hi, now_.side()) == 0;
            if (turns) thrown.friction[j].way = (wall > 0) == out ? Motion::backward : Motion::forward;
        }
        Balance found;
        const Frame frame(problem_.system, thrown);
        if (!balances_->at_present(now_.here(), now_, thrown, frame, segment_, found)) return -model::never;
        return wall * own.sum(found.accelerations);
    };
    const double out = back_in(true), back = back_in(false);
    if (out == -model::never || back == -model::never) return {};
    if (!(out > 0)) return Bounces{};
    if (!(back > 0)) return Bounces{speed / out, speed / out};  // friction holds the mass at the top of the bounce
    const double slower = std::sqrt(back / out), once = speed * (1 / out + slower / back);
    const double kept = own.walls->restitution * slower;
    return Bounces{once, kept < 1 ? once / (1 - kept) : model::never};
}

/// Switches relays whose level is the angle at which a wall has just been met, whatever the rounding of both.
void Engine::switch_at_wall() {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        Signal& load = mechanics_.loads()[j];
        for (std::size_t r = 0; r < load.relays(); ++r) {
            const bool of_angle = load.switching(r).place.value_or(n()) < n();
            if (!of_angle || load.until_switch(r, now_.here()) > 0) continue;
            load.toggle(r);
            report_event(EventKind::switched, j);
        }
    }
}

bool Engine::hit(std::size_t joint, int wall) {
    const Joint& own = problem_.system.joints[joint];
    const double place = own.walls->at(wall), e = own.walls->restitution;
    const bool stayed = contacts_.of[joint].leaves_wall;
    now_.put_child(own, own.first(), own.of.front().by, place);
    switch_at_wall();
    walls_.struck(joint, place);
    const double before = std::max(0.0, wall * mechanics_.velocity(joint, now_.y));
    contacts_.of[joint].leaves_wall = true;
    const auto stands = [&] {
        if (now_.mode.leans[joint] != wall || contacts_.of[joint].leaned) return;
        report_event(EventKind::stick, joint);
        contacts_.of[joint].leaned = true;
    };
    if (stayed && before == 0) {
        now_.mode.leans[joint] = wall;
        now_.mode.friction[joint].leaving = false;
        Chatter::raise_margin(now_.mode.friction[joint], torque_size(joint));  // the joint was released without leaving
        if (!decide(true)) return false;
        stands();
        return goes_on();
    }
    const Impulses::Thrown thrown = impulses_.along(joint, now_);
    if (is_driven(joint, thrown)) return fail(Outcome::blocked);
    report_event(EventKind::impact, joint);
    constexpr int most_low = 32, few_heights = 64;
    const double unresolved = 4 * rounding * (std::fabs(place) + own.size(now_.y));
    const double since = now_.t.hi - std::exchange(walls_.impact[joint], now_.t.hi);
    walls_.low[joint] = before * since <= few_heights * unresolved ? walls_.low[joint] + 1 : 0;
    const double pace = std::min(pace_.period, now_.t.hi - pace_.born);
    if (!(now_.t.hi - walls_.instant <= last_bounces * pace)) walls_.fastest = 0;
    walls_.instant = now_.t.hi, walls_.fastest = std::max(walls_.fastest, before);
    const double nothing =
        std::max(faded_impact * walls_.fastest, 64 * rounding * mechanics_.speed_scale(joint, now_.y));
    const bool fades = before > 0 && before < nothing;
    const auto velocity = [&](double relative) { Impulses::apply(thrown, relative, now_); };
    const double energy = kinetic_energy();
    velocity(-wall * e * before);
    conditions_->forget();
    bool rests = fades || e * before == 0;
    double rest = 0;
    if (!rests) {
        const auto bounces = next_bounces(joint, wall, e * before);
        if (!bounces) return fail(Outcome::excitation_not_finite);
        // Without a spring, "short" is relative to the run so far, not to its end, so that stopping and resuming
        // changes nothing.
        // A bounce lower than the rounding of the angles counts as rest. Between two walls, or if a load jumps near the
        // wall, only past bounces show that.
        const bool unseen = e * before * bounces->once <= unresolved || walls_.low[joint] > most_low;
        rests = bounces->all <= last_bounces * pace || bounces->once <= shortest_bounce * pace || unseen;
        rest = bounces->all < model::never ? bounces->all : bounces->once;
    }
    const double after = rests ? 0 : e * before;
    const double lost = (before - after) * (before + after) / thrown.lightness / 2;
    recorder_->add_jump(now_.t.hi, joint, {.impacts = lost});
    breaks_.echo(now_.t.hi, 1);
    for (std::size_t i = 0; i < n(); ++i) {
        if (thrown.velocities[i].second != 0) recorder_->set_heading(i, rests ? 0 : now_.y[n() + i]);
    }
    if (rests) {
        velocity(0);
        conditions_->forget();
    }
    add_work_of_moved(joint, energy, lost);
    if (rests) wait(rest);
    leave_walls(stop_row(joint, wall, fades));
    if (rests) lean(joint, wall);
    if (!restart_contacts(Because::impact, joint)) return false;
    if (rests) stands();
    // Bounces at one wall end by themselves; those between several walls need not, or only after very many.
    constexpr int most_to_and_fro = 5000;
    const bool other = walls_.last_hit != std::pair(joint, wall);
    walls_.last_hit = {joint, wall};
    return !other || !chatter_.too_often(now_.t.hi, most_to_and_fro) || fail(Outcome::chattering);
}

/// Makes a joint lean on a wall against which it has come to rest.
void Engine::lean(std::size_t joint, int wall) {
    now_.mode.leans[joint] = wall;
    if (!now_.rubs(joint)) return;
    Slipping& how = now_.mode.friction[joint];
    if (how.way != Motion::stuck) contacts_.of[joint].arrived = how.way;
    how.leaving = false;
}

/// Returns whether bodies with a prescribed motion drive the joint, so that no impulse changes its velocity.
bool Engine::is_driven(std::size_t joint, const Impulses::Thrown& thrown) const {
    constexpr double rounded = 1e-12;
    double alone = 0;
    for (const auto& [body, by] : joint_at(joint).of) {
        if (const double inertia = mechanics_.own_inertia(body); inertia > 0) alone += by * by / inertia;
    }
    return problem_.hidden > 0 && !(thrown.lightness > rounded * alone);
}

/// Stops masses in a row that would otherwise strike each other endlessly: after an impact that `fades` all that lean,
/// and without rebound those that are thrown into their walls. Returns the joints that stopped.
std::vector<char> Engine::stop_row(std::size_t joint, int wall, bool fades) {
    const auto& joints = problem_.system.joints;
    std::vector<char> stopped(joints.size(), 0);
    const bool dead = joints[joint].walls->restitution == 0;
    bool strikes = fades;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        if (j == joint || now_.mode.leans[j] == 0) continue;
        const double into = now_.mode.leans[j] * mechanics_.velocity(j, now_.y);
        stopped[j] = fades || (dead && joints[j].walls->restitution == 0 && into >= 0) ? 1 : 0;
        strikes = strikes || (stopped[j] != 0 && into > 0);
    }
    if (!strikes) return {};
    stopped[joint] = 1;
    now_.mode.leans[joint] = wall;
    recorder_->add_jump(now_.t.hi, joint, {.impacts = stop_together(stopped)});
    return stopped;
}

/// Makes joints that leaned and were struck leave: away from the wall, or into it, which is another impact.
void Engine::leave_walls(const std::vector<char>& stopped) {
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        const double v = mechanics_.velocity(j, now_.y);
        if (now_.mode.leans[j] == 0 || v == 0 || (!stopped.empty() && stopped[j] != 0)) continue;
        if (contacts_.of[j].leaned && now_.mode.leans[j] * v < 0) report_event(EventKind::slip, j);
        now_.mode.leans[j] = 0, contacts_.of[j].leaned = false, contacts_.of[j].leaves_wall = true;
    }
}

bool Engine::act_all(const std::vector<std::size_t>& events) {
    users_.flip_sides(events);
    if (!std::all_of(events.begin(), events.end(), [&](std::size_t event) { return act(event, events); })) return false;
    // All simultaneous events are reported before one stops the run, as a continued run would not report them.
    const bool stops =
        std::any_of(events.begin(), events.end(), [&](std::size_t event) { return problem_.drive.events[event].stop; });
    return !stops || fail(Outcome::stopped);
}

bool Engine::act(std::size_t event, const std::vector<std::size_t>& events) {
    const model::WantedEvent& wanted = problem_.drive.events[event];
    recorder_->report_user_event(now_, event);
    if (wanted.act != nullptr) {
        const std::vector<double> before = now_.y;
        const std::vector<double> values = users_.values(now_.here());
        model::State state{now_.y[0], now_.y[n()]};
        const bool named = problem_.system.named;
        const std::span<double> all(now_.y);
        const std::span<double> given = all.first(convention_.passed);
        mechanics_.call_unread(now_.here(), now_.mode);
        if (!wanted.act->act(now_.t.hi, state, named ? given : given.subspan(2 * n()))) {
            return fail(Outcome::excitation_not_finite);
        }
        if (!named) now_.y[0] = state.theta, now_.y[1] = state.velocity;
        Walls::keep_within(problem_.system, now_.y);
        conditions_->forget();
        // the user's action saw the rounded angles, so the run continues from them
        if (now_.y != before) now_.low.assign(n(), 0);
        now_.keep_rigid_places(problem_.system);
        const bool moved =
            !std::equal(now_.y.begin(), now_.y.begin() + static_cast<std::ptrdiff_t>(2 * n()), before.begin());
        if (moved) {
            std::fill(now_.mode.leans.begin(), now_.mode.leans.end(), 0);
            align_rigid_velocities();
        }
        for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
            const double work = energy_at(j, now_.y) - energy_at(j, before);
            if (work != 0 || j == 0) recorder_->add_jump(now_.t.hi, j, {.acts = work});
        }
        breaks_.echo(now_.t.hi, 1);
        if (moved) {
            for (std::size_t i = 0; i < n(); ++i) recorder_->set_heading(i, now_.y[n() + i]);
            touch_walls();
            if (!restart_contacts(Because::act)) return false;
            shorten_for_flight();
        }
        conditions_->decide({now_.t.hi, now_.side(), now_.departing(problem_.system, scratch_.departing)}, now_.mode,
                            segment_);
        users_.set_sides_after_actions(values, now_.y != before ? events : std::vector<std::size_t>(), now_, segment_,
                                       pace_.h, *balances_, frames_->of(now_.mode));
        if (moved && users_.fades(event, now_.t.hi) && !wanted.stop) return fail(Outcome::chattering);
    }
    return wanted.stop || goes_on();
}

/// Shortens the next stretch if a body is in a short flight that returns soon.
void Engine::shorten_for_flight() {
    if (!balances_->at_present(now_, frames_->of(now_.mode), segment_, room_.balance)) return;
    for (std::size_t i = 0; i < n(); ++i) {
        const double v = now_.y[n() + i], a = room_.balance.accelerations[i];
        if (!(v * a < 0) || !(std::fabs(v) < std::fabs(a) * frames_->of(now_.mode).longest)) continue;
        pace_.h = std::min(pace_.h, std::max(1.2 * std::fabs(v / a), 1e-9 * pace_.unit));
    }
}

/// Returns the energy stored in a joint, plus the kinetic energy of the body if it is the joint with the ground.
double Engine::energy_at(std::size_t joint, const std::vector<double>& y) const {
    const Joint& own = problem_.system.joints[joint];
    const double q = mechanics_.angle(joint, y);
    const double kinetic =
        joint < n() ? problem_.system.bodies[joint].inertia * y[n() + joint] * y[n() + joint] / 2 : 0;
    return kinetic + own.stiffness * q * q / 2 + own.spring.energy(q);
}

}  // namespace dinal::motion::engine
