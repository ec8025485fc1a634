#include "support/stops_truth.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "support/crossing.hpp"

namespace dinal::truth {

namespace {

using model::EventKind;
constexpr long patience = 20000;
/// Bounces slower than this follow each other under a torque that stays as it is: their sum is a geometric series.
constexpr real slowest_bounce = 1e-9L;

int sign_of_real(real x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

}  // namespace

StopsTruth::StopsTruth(StopsSystem system, const Motion& initial, real t_start, real t_end, std::vector<double> times,
                       real tolerance)
    : s_(std::move(system)),
      t_(t_start),
      t_start_(t_start),
      t_end_(t_end),
      tolerance_(tolerance),
      times_(std::move(times)),
      y_{initial.theta, initial.velocity} {
    begin();
    while (t_ < t_end_ && !gave_up_) {
        mode_ == Mode::moving ? move() : stand();
        gave_up_ = gave_up_ || steps_ > patience;
    }
    while (motions_.size() < times_.size()) motions_.push_back({y_[0] + origin_, y_[1]});
}

void StopsTruth::begin() {
    sign_ = sign_of_real(y_[1]);
    if (y_[1] != 0) return;
    if (s_.walls) {
        for (const int side : {1, -1}) {
            if (y_[0] == wall_off(side)) {
                origin_ += y_[0];
                y_[0] = 0;
                side_ = side;
                mode_ = Mode::leaning;
                return;
            }
        }
    }
    if (dry()) settle(false);
}

/// All but friction.
real StopsTruth::torque(real t, const Point& y) const {
    const real theta = origin_ + y[0];
    return s_.M(t, {theta, y[1]}) - s_.k * theta - s_.spring(theta) - s_.C * y[1];
}
real StopsTruth::pull(real t) const {
    return torque(t, {y_[0], 0});
}
real StopsTruth::acceleration(real t, const Point& y) const {
    const real Rd = sign_ == 0 ? 0 : static_cast<real>(sign_) * s_.Rd[sign_ > 0 ? 1 : 0];
    return (torque(t, y) - Rd) / s_.I;
}

StopsTruth::Point StopsTruth::stepped(const Point& y, real t, real h) const {
    if (!(h > 0)) return y;
    Point z = y;
    boost::numeric::odeint::runge_kutta_fehlberg78<Point, real>().do_step(
        [&](const Point& p, Point& dp, real at) {
            dp = {p[1], acceleration(at, p)};
        },
        z, t, h);
    return z;
}

/// What a mass at velocity zero does, away from walls.
void StopsTruth::settle(bool from_motion) {
    const real net = pull(t_);
    const int way = sign_of_real(net), before = sign_;
    if (std::fabs(net) <= s_.Re[way > 0 ? 1 : 0]) {
        mode_ = Mode::stuck;
        sign_ = 0;
        if (from_motion) tell(EventKind::stick);
        return;
    }
    sign_ = way;
    mode_ = Mode::moving;
    if (from_motion && way != before) tell(EventKind::turn);
}

void StopsTruth::move() {
    const real longest = 0.5L / s_.quickest;
    real h = std::min(longest / 100, t_end_ - t_);
    if (s_.walls && y_[0] == 0 && origin_ != 0) {  // after an impact: not longer than the bounce
        const real a = acceleration(t_, y_);
        if (a * y_[1] < 0) h = std::min(h, std::fabs(y_[1] / a) / 3);
    }
    while (t_ < t_end_ && mode_ == Mode::moving && ++steps_ < patience) {
        const bool last = t_ + h >= t_end_;
        const real length = last ? t_end_ - t_ : h;
        const Point once = stepped(y_, t_, length);
        const Point half = stepped(y_, t_, length / 2), end = stepped(half, t_ + length / 2, length / 2);
        const real scale = std::fabs(y_[1]) * length + std::fabs(end[0] - y_[0]);
        const real error = std::fabs(end[0] - once[0]) + length * std::fabs(end[1] - once[1]);
        // What is rounded off the numbers themselves is no error of the step.
        const real rounded = 1e-18L * (std::fabs(end[0]) + length * std::fabs(end[1])) + 1e-30L;
        const real excess = error / (tolerance_ * scale + rounded);
        const real next = length * std::clamp<real>(0.8L * std::pow(excess + 1e-9L, -1 / 8.0L), 0.1L, 3);
        if (excess > 1 && length > 1e-7L) {
            h = next;
            continue;
        }
        largest_ = std::max({largest_, std::fabs(end[0] + origin_), std::fabs(end[1])});
        if (!(largest_ < 1e4L)) {
            gave_up_ = true;
            return;
        }
        if (find_event(y_, length)) return;
        tell_rows(y_, t_ + length);
        y_ = end;
        t_ = last ? t_end_ : t_ + length;
        h = std::min(next, longest);
    }
}

/// The first velocity zero, or passage of a wall, within h. True when there is one; it was dealt with.
bool StopsTruth::find_event(const Point& from, real h) {
    const auto at = [&](real x) { return stepped(from, t_, x); };
    const Point end = at(h);
    real zero = h * 2, wall = h * 2;
    int side = 0;
    const int way = from[1] != 0 ? sign_of_real(from[1]) : sign_ != 0 ? sign_ : sign_of_real(end[1]);
    const auto velocity = [&](real x) { return static_cast<real>(way) * at(x)[1]; };
    const real v_end = velocity(h);
    if (v_end <= 0) {
        real a = 0;
        if (velocity(0) <= 0) {
            a = h / 2;
            while (velocity(a) <= 0 && a > 1e-18L * h) a /= 2;
        }
        if (const real v = velocity(a); v > 0) zero = smooth_crossing(velocity, a, v, h, v_end);
    } else {
        const auto falling = [&](real x) { return -static_cast<real>(way) * acceleration(t_ + x, at(x)); };
        if (falling(0) > 0 && falling(h) < 0) {
            const real lowest = crossing(falling, 0, h);
            if (velocity(lowest) <= 0) zero = crossing(velocity, 0, lowest);
        }
    }
    const real until = std::min(zero, h);
    if (s_.walls) {
        for (const int s : {1, -1}) {
            if (s != way) continue;
            const auto gap = [&](real x) { return static_cast<real>(s) * (wall_off(s) - at(x)[0]); };
            const real begin = gap(0), end_gap = gap(until);
            if (end_gap > 0) continue;
            wall = begin <= 0 ? 0 : smooth_crossing(gap, 0, begin, until, end_gap);
            side = s;
        }
    }
    if (side == 0 && zero > h) return false;
    const real x = side != 0 ? wall : zero;
    tell_rows(from, t_ + x);
    y_ = at(x);
    t_ += x;
    if (side != 0) {
        hit(side, y_[1]);
    } else if (dry()) {
        y_[1] = 0;
        settle(true);
    } else {
        y_[1] = 0;
        sign_ = -way;
        tell(EventKind::turn);
        sign_ = 0;
        // It goes the other way; begin a hair later, so that the zero is not found again.
        const real hair = 1e-12L;
        tell_rows(y_, t_ + hair);
        y_ = stepped(y_, t_, hair);
        t_ += hair;
    }
    return true;
}

void StopsTruth::hit(int side, real velocity) {
    origin_ += wall_off(side);
    y_ = {0, velocity};
    tell(EventKind::impact, velocity);
    y_[1] = -s_.walls->restitution * velocity;
    sign_ = dry() ? -side : 0;
    if (std::fabs(y_[1]) > slowest_bounce) return;
    // Out under pull and friction, back under pull less friction, which is slower; each bounce slower than the last.
    const real out = -static_cast<real>(side) * acceleration(t_, {0, 0});
    sign_ = dry() ? side : 0;
    const real back = -static_cast<real>(side) * acceleration(t_, {0, 0});
    sign_ = dry() ? -side : 0;
    if (y_[1] == 0) {
        lean(side, 0);
    } else if (out < 0 && back < 0) {
        const real slower = std::sqrt(back / out), v = std::fabs(y_[1]);
        lean(side, v * (-1 / out - slower / back) / (1 - s_.walls->restitution * slower));
    }
}

/// At rest against the wall, that much later, unless it is pulled away.
void StopsTruth::lean(int side, real after) {
    const Point here{0, 0};
    y_ = here;
    tell_rows(here, std::min(t_ + after, t_end_));
    t_ = std::min(t_ + after, t_end_);
    side_ = side;
    const real away = -static_cast<real>(side) * pull(t_);
    if (away > s_.Re[side > 0 ? 0 : 1]) {
        sign_ = dry() ? -side : 0;
        mode_ = Mode::moving;
        return;
    }
    mode_ = Mode::leaning;
    tell(EventKind::stick);
}

/// Stuck, or leaning against a wall, until the pull is too much.
void StopsTruth::stand() {
    real released = t_end_;
    int towards = 0;
    for (const int way : {1, -1}) {
        if (mode_ == Mode::leaning && way == side_) continue;
        const auto left = [&](real t) { return s_.Re[way > 0 ? 1 : 0] - static_cast<real>(way) * pull(t); };
        const real step = 0.1L / s_.quickest;
        real before = left(t_), last = t_;
        if (before < 0) {
            released = t_, towards = way;
            break;
        }
        for (real t = t_ + step;; t += step) {
            const real x = std::min(t, t_end_), now = left(x);
            if (now < 0) {
                const real found = crossing(left, last, x);
                if (found < released) released = found, towards = way;
                break;
            }
            if (x >= t_end_) break;
            last = x;
        }
    }
    tell_rows({y_[0], 0}, released);
    t_ = released;
    if (towards == 0) return;
    sign_ = dry() ? towards : 0;
    mode_ = Mode::moving;
    tell(EventKind::slip);
}

void StopsTruth::tell(EventKind kind, real velocity) {
    if (t_ > t_start_) events_.push_back({t_, kind, y_[0] + origin_, velocity});
}

void StopsTruth::tell_rows(const Point& from, real until) {
    while (motions_.size() < times_.size() && static_cast<real>(times_[motions_.size()]) < until) {
        const real x = static_cast<real>(times_[motions_.size()]) - t_;
        const Point y = mode_ == Mode::moving ? stepped(from, t_, x) : from;
        motions_.push_back({y[0] + origin_, y[1]});
    }
}

}  // namespace dinal::truth
