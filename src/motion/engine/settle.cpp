// Rest on a surface at which a load jumps. If dry friction stops a body on both sides of the surface, and the load
// drives it back each time, the body crosses the surface at shrinking intervals and comes to rest on it.
#include <algorithm>
#include <cmath>

#include "motion/engine/engine.hpp"

namespace dinal::motion::engine {

using model::Motion;

namespace {

// In units of the time scale of the motion: torques hardly change during last_passages, and crossings closer than
// shortest_passage are lost in the rounding of angles.
constexpr double last_passages = 1e-6, shortest_passage = 4e-9;
// If the intervals shrink so slowly that more are needed, it is not friction that stops the body.
constexpr double most_legs = 1000;
constexpr double of_rounding = 64 * rounding, clearly_seen = 32;

}  // namespace

/// Handles a surface that was crossed back and forth. The body rests if the remaining crossings take a negligible time.
Engine::Settles Engine::settle(const Conditions::Crossed::Back& back) {
    const auto loaded = mechanics_.joint_of(*back.function, now_.t.hi);
    if (!loaded) return Settles::no;
    const std::size_t joint = *loaded;
    if (!now_.rubs(joint) || mechanics_.has_belt(joint) || now_.mode.leans[joint] != 0) return Settles::no;
    const double speed = now_.slip(mechanics_, joint);
    if (speed == 0) return Settles::no;
    Now still = now_;
    const Impulses::Thrown thrown = impulses_.along(joint, now_);
    Impulses::apply(thrown, 0, still);
    const double size = std::fabs(mechanics_.angle(joint, now_.y));
    const double far = std::max(of_rounding * size, std::fabs(speed) * back.since / 16);
    const auto passages = next_passages(joint, still, speed, far);
    if (!passages || !put_on_surface(back, joint, still, far, speed, passages->all)) return Settles::no;
    const double pace = std::min(pace_.period, now_.t.hi - pace_.born);
    const bool seen =
        passages->leg > shortest_passage * pace && std::fabs(speed) * passages->leg > clearly_seen * of_rounding * size;
    if (seen && passages->all > most_legs * passages->leg) return Settles::no;
    if (seen && passages->all > last_passages * pace) return Settles::soon;
    const double energy = kinetic_energy(), lost = speed * speed / thrown.lightness / 2;
    recorder_->add_jump(now_.t.hi, joint, {.dry = lost});
    const Motion way = model::motion_of(speed);
    now_.y = still.y, now_.low = still.low;
    add_work_of_moved(joint, energy, lost);
    wait(passages->all);
    now_.mode.friction[joint].leaving = false;
    contacts_.of[joint].arrived = way;
    conditions_->forget();
    return Settles::now;
}

/// Returns the time of the next two crossings, and of all, from this speed at the surface, under constant torques;
/// empty if they do not converge to the surface. In `still` the joint rests on the surface; torques are evaluated at
/// the distance `far` from it.
std::optional<Engine::Passages> Engine::next_passages(std::size_t joint, const Now& still, double speed, double far) {
    const Motion ahead = model::motion_of(speed), behind = model::motion_of(-speed);
    const auto back_in = [&](Motion side, Motion way) {
        Mode mode = now_.mode;
        Slipping& how = mode.friction[joint];
        how.way = way, how.leaving = how.riding = false;
        std::vector<double> y;
        const Moment at = just_beside(still.here(), slip_alone(mechanics_, mode, joint), {side, way, far}, y);
        Balance found;
        const bool good = balances_->at_present(at, still, mode, Frame(problem_.system, mode), segment_, found);
        return good ? -model::sign_of(side) * joint_at(joint).sum(found.accelerations) : 0;
    };
    double leg = 0, v = std::fabs(speed);
    for (const Motion side : {ahead, behind}) {
        const double out = back_in(side, side), back = back_in(side, side == ahead ? behind : ahead);
        if (!(out > 0) || !(back > 0)) return {};
        const double slower = std::sqrt(back / out);
        leg += v * (1 / out + slower / back);
        v *= slower;
    }
    const double kept = v / std::fabs(speed);
    if (!(kept < 1)) return {};
    return Passages{leg, leg / (1 - kept)};
}

/// Moves the joint to the exact zero of the condition's margin. Returns false if the surface moves away while the joint
/// rests.
bool Engine::put_on_surface(const Conditions::Crossed::Back& back, std::size_t joint, Now& still, double far,
                            double speed, double later) {
    constexpr double hardly = 1e-3;
    // The surface of a staircase's step may be at either end of the step.
    Piecewise function = *back.function;
    const std::size_t step = function.conditions()[back.condition].step;
    function.decide(still.here(), 0);
    std::vector<double> margins;
    function.margins(still.here(), margins);
    std::optional<std::size_t> nearest;
    for (std::size_t c = 0; c < margins.size(); ++c) {
        if (function.conditions()[c].step != step) continue;
        if (!nearest || std::fabs(margins[c]) < std::fabs(margins[*nearest])) nearest = c;
    }
    if (!nearest) return false;
    const auto margin = [&](double t, const std::vector<double>& y) {
        function.margins({t, Side::at, y}, margins);
        return margins[*nearest];
    };
    const model::Weight& first = joint_at(joint).of.front();
    double slope = 0;
    for (int i = 0; i < 2; ++i) {
        std::vector<double> beside = still.y;
        beside[first.body] += far;
        const double here = margin(now_.t.hi, still.y);
        slope = (margin(now_.t.hi, beside) - here) / far;
        if (here == 0) break;
        still.y[first.body] -= here / slope;
        still.low[first.body] = 0;
    }
    std::vector<double> then = still.y, rates(mechanics_.states());
    mechanics_.rates(still.here(), rates.data(), &still.mode);
    for (std::size_t i = 0; i < n(); ++i) then[i] += later * still.y[n() + i];
    for (std::size_t k = 0; k < rates.size(); ++k) then[2 * n() + k] += later * rates[k];
    const double moved = margin(now_.t.after(later), then) - margin(now_.t.hi, still.y);
    return std::fabs(moved) <= hardly * std::fabs(slope * speed * later) + of_rounding * std::fabs(slope * far);
}

/// Advances the time and users' states by a short time, unless a break or the end comes first. If other bodies move, it
/// does nothing, and the present body rests slightly too early.
void Engine::wait(double rest) {
    const auto velocities = now_.y.begin() + static_cast<std::ptrdiff_t>(n());
    if (std::any_of(velocities, velocities + static_cast<std::ptrdiff_t>(n()), [](double v) { return v != 0; })) return;
    if (!(rest > 0) || !(now_.t.after(rest) < std::min(next_break(), problem_.window.end))) return;
    std::vector<double> rates(mechanics_.states());
    mechanics_.rates(now_.here(), rates.data(), &now_.mode);
    for (std::size_t k = 0; k < rates.size(); ++k) now_.y[2 * n() + k] += rest * rates[k];
    now_.t = now_.t.later(rest);
}

}  // namespace dinal::motion::engine
