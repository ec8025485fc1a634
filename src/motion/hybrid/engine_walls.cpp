// Walls: impacts, bounces that die out, and a mass that stands at a wall until it is pulled off.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

namespace {

/// Bounces that are over within this part of the pace follow each other under torques that stay as they are: what
/// changes in that time is its square. So their sum is a geometric series, and what remains of them is rest.
constexpr double last_bounces = 1e-8;
/// A bounce shorter than this, again in units of the pace, is none, even where nothing is lost in it.
constexpr double shortest_bounce = 1e-10;

model::Motion way_of(int side) {
    return side > 0 ? model::Motion::forward : model::Motion::backward;
}
int side_of(model::Motion way) {
    return way == model::Motion::forward ? 1 : -1;
}
model::Motion opposite(model::Motion way) {
    return way == model::Motion::forward ? model::Motion::backward : model::Motion::forward;
}

}  // namespace

/// The torque of the belt's friction on a mass that stands at a wall.
double Engine::sliding_at_wall(double belt) const {
    const model::Motion slides = model::motion_of(-belt);
    return -system_.braking(slides) - system_.friction_remainder(slides, {theta(), -belt});
}

/// What the belt adds to the pull at a wall. Friction that slides holds nothing, so the limit of sticking is taken out
/// of the pull that is compared with it.
double Engine::belt_at_wall(double belt) const {
    if (belt == 0) return 0;
    const model::Motion away = opposite(standstill_.leans());
    return sliding_at_wall(belt) + model::sign_of(away) * system_.holding(away);
}

/// The same, now. A belt that sets off from the wall takes the mass along where sticking can do that.
double Engine::belt_at_wall() const {
    const double heading = belt_heading();
    const double added = belt_at_wall(heading);
    const model::Motion into = standstill_.leans(), away = opposite(into);
    if (std::fabs(heading) != Field::hair || model::motion_of(heading) != away) return added;
    const double follows = system_.holding(into) - system_.inertia() * std::fabs(field_.belt_slope(now_.hi).sure());
    return added + model::sign_of(away) * std::max(0.0, follows - std::fabs(sliding_at_wall(heading)));
}

/// At the start, or where a user put it: a mass that is exactly at a wall stands there, or hits it.
void Engine::touch_wall(bool goes_on) {
    const auto& walls = problem_.system.walls();
    if (!walls) return;
    for (const int side : {1, -1}) {
        if (theta() != walls->at(side)) continue;
        stand_at(walls->at(side));
        if (y_[1] * side < 0) return;
        if (y_[1] != 0) {
            hit(way_of(side));
        } else if (goes_on) {
            standstill_.return_to(problem_.before == model::Motion::stuck
                                      ? Standstill::Mark{model::Motion::stuck, Standstill::Phase::stuck}
                                      : Standstill::Mark{opposite(way_of(side)), Standstill::Phase::leaving});
            standstill_.lean(way_of(side));
        } else {
            come_to_lean(way_of(side));
        }
        return;
    }
}

/// Of a mass that moves, now.
double Engine::acceleration() const {
    const double M = field_.load(here()), slip = y_[1] - belt();
    const model::Motion motion = way();
    const double friction = system_.braking(motion) + system_.friction_remainder(motion, {theta(), slip});
    return (M + field_.push(now_.hi, here().side) - friction - system_.damping() * y_[1] - system_.pull_back(theta())) /
           system_.inertia();
}

/// How long it would take under this acceleration to a place on this side; `never` when that does not lead there.
double Engine::until(int side, double place, double a) const {
    const double gap = std::max(0.0, side * ((place - origin_) - y_[0]));
    const double v = side * y_[1], b = side * a, root = v * v + 2 * b * gap;
    if (!(root >= 0) || !(gap < model::never)) return model::never;
    const double t = v > 0 ? 2 * gap / (v + std::sqrt(root)) : b > 0 ? (std::sqrt(root) - v) / b : model::never;
    if (t > 0) return t;
    return model::never;
}

double Engine::until_wall() const {
    const model::Walls& walls = *problem_.system.walls();
    const double a = acceleration();
    return std::min(until(1, walls.upper, a), until(-1, walls.lower, a));
}

/// What the roundings of its way may have made of the distance to a wall. An arrival at velocity 0 that they push into
/// the wall would be an impact, and lose their square root.
double Engine::blurred_gap(double wall) const {
    constexpr double few = 64;
    return few * rounding * std::max(reach_, std::fabs(wall - origin_));
}

/// Where the velocity came down to zero right at a wall the mass is there to the letter.
void Engine::touch() {
    const auto& walls = problem_.system.walls();
    if (!walls || leans()) return;
    for (const int side : {1, -1}) {
        const double wall = walls->at(side);
        if (std::isfinite(wall) && std::fabs((wall - origin_) - y_[0]) <= blurred_gap(wall)) return stand_at(wall);
    }
}

/// A wall, if the mass comes to it before the end that is known so far.
void Engine::watch_walls(Ending& ending) const {
    using namespace spectral::chebyshev;
    if (standstill_.stuck() && !field_.has_belt()) return;
    const auto no = [](double) { return false; };
    for (const int side : {1, -1}) {
        const double wall = problem_.system.walls()->at(side);
        if (!std::isfinite(wall)) continue;
        Series gap = piece_.series[0];
        for (double& c : gap) c *= -side;
        const double begin = side * ((wall - origin_) - y_[0]);
        gap[0] += begin;
        Bounded<points> curve(1, gap, derivative(gap));
        curve.raise_floor(blurred_gap(wall));
        const auto x = first_below(curve, -1, begin == 0 ? LeftEnd::leaving : LeftEnd::anywhere, no);
        if (x && *x < ending.x) ending = {*x, By::wall, 0, way_of(side)};
    }
}

/// Where a belt turns round along a mass at a wall the piece is to end, and is solved again: friction jumps there.
bool Engine::belt_turns_at_wall() {
    if (!field_.has_belt() || !leans() || belt_turns_ < model::never) return false;
    constexpr double within = 1 - 1e-9;
    const auto exact = [&](double x) { return field_.belt(piece_.time(x), Side::at); };
    Half half = 0;
    const auto x = Watched(piece_.belt, exact).leaves(half, -1);
    if (!x || !(std::fabs(*x) < within) || !(piece_.time(*x) > now_.hi)) return false;
    belt_turns_ = piece_.time(*x);
    return true;
}

/// How long the bounce lasts that begins now, and how long all of them go on; `never` when they do not end.
Engine::Bounces Engine::bounces(model::Motion into) const {
    const double s = model::sign_of(into), M = field_.load(here()), speed = std::fabs(y_[1]);
    const double loads = M + field_.push(now_.hi, here().side) - system_.pull_back(theta());
    // Friction acts against the sliding: out and back again, or, on a belt that goes along, the same way all the time.
    const double b = belt();
    const auto back_in = [&](model::Motion moves) {
        return s * (loads + (b == 0 ? -system_.braking(moves) : sliding_at_wall(b))) / system_.inertia();
    };
    const double out = back_in(opposite(into)), back = back_in(into);
    if (!(out > 0)) return {model::never, model::never};
    if (!(back > 0)) return {speed / out, speed / out};  // friction holds it at the top of the bounce
    const double slower = std::sqrt(back / out), once = speed * (1 / out + slower / back);
    const double kept = problem_.system.walls()->restitution * slower;
    return {once, kept < 1 ? once / (1 - kept) : model::never};
}

/// The mass has come to a wall, or did not get away from it.
bool Engine::hit(model::Motion into) {
    const model::Walls& walls = *problem_.system.walls();
    const int side = side_of(into);
    const double before = std::max(0.0, side * y_[1]);
    const bool other = origin_ != walls.at(side);
    const bool stayed = y_[0] == 0 && origin_ == walls.at(side) && before == 0;
    stand_at(walls.at(side));
    if (stayed) {
        standstill_.lean(into);
        return standstill_.never_left({now_.hi, theta(), pull(field_.load(here()))}) ||
               fail(model::Outcome::chattering);
    }
    y_[1] = side * before;
    tell(model::EventKind::impact);
    y_[1] = -walls.restitution * y_[1];
    double after = y_[1] * side * -1;
    const auto [once, all] = after > 0 ? bounces(into) : Bounces{};
    const double soon = std::min(field_.next_break(now_.hi), problem_.window.end);
    // Without a spring the run so far tells what is short: not t_end, so that one may stop anywhere and go on.
    const double pace = std::min(problem_.system.natural_period(), now_.hi - born_);
    const bool over = all <= last_bounces * pace || once <= shortest_bounce * pace;
    const double rest = all < model::never ? all : once;
    // To and fro between walls that are too near to each other.
    if (other && impacts_.after(now_.hi, shortest_bounce * pace_)) return fail(model::Outcome::chattering);
    if (over) after = 0;
    const double lost = system_.inertia() / 2 * (before - after) * (before + after);
    if (problem_.limits.dense) pieces_->add_jump(now_.hi, {.impacts = lost});
    echo(now_.hi, 1);
    if (over) {
        if (rest > 0 && now_.after(rest) < soon) {
            Values rates(y_.size());
            field_.rates(here(), rates.data() + 2);
            for (std::size_t k = 2; k < y_.size(); ++k) y_[k] += rest * rates[k];
            now_ = now_.later(rest);
        }
        come_to_lean(into);
        return true;
    }
    const double slip = y_[1] - belt();
    standstill_.thrown(slip == 0 ? model::motion_of(y_[1]) : model::motion_of(slip));
    if (slip == 0 && !standstill_.passes()) standstill_.arrive();
    return true;
}

/// At rest at a wall; the law of friction is asked before anything else.
void Engine::come_to_lean(model::Motion against) {
    stand_at(problem_.system.walls()->at(side_of(against)));
    y_[1] = 0;
    standstill_.thrown(opposite(against));
    standstill_.lean(against);
    standstill_.arrive();
}

/// What a wall let go on a moving belt slides as the belt says, wherever it goes.
void Engine::go_from_wall() {
    if (standstill_.leans() == model::Motion::stuck || standstill_.stuck()) return;
    const double heading = belt_heading();
    if (heading == 0) return;
    const model::Motion away = opposite(standstill_.leans());
    standstill_.thrown(model::motion_of(-heading));
    if (std::fabs(heading) != Field::hair) return;
    // It and the belt have the same velocity still: if the belt outruns it, or it the belt, the law says.
    const double M = field_.load(here());
    const model::Motion towards =
        model::motion_of(heading) == away ? standstill_.pulled(pull(M), theta()) : model::motion_of(-heading);
    standstill_.return_to(
        {towards, towards == model::Motion::stuck ? Standstill::Phase::stuck : Standstill::Phase::leaving});
}

}  // namespace dinal::motion::hybrid
