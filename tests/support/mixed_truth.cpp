#include "support/mixed_truth.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

namespace dinal::truth {

namespace {

enum What { nothing, stands, lets_go, hits, corner, switches, user };

int sign(real x) {
    return x > 0 ? 1 : x < 0 ? -1 : 0;
}

}  // namespace

std::vector<Sliding> lines_through(const std::vector<double>& speed, const std::vector<double>& torque) {
    std::vector<Sliding> ranges;
    for (std::size_t i = 0; i + 1 < speed.size(); ++i) {
        const real v0 = speed[i], T0 = torque[i], v1 = speed[i + 1], slope = (torque[i + 1] - T0) / (v1 - v0);
        ranges.push_back({[=](int, real v) { return T0 + slope * (v - v0); }, std::fabs(slope), v1});
    }
    ranges.push_back({[last = torque.back()](int, real) -> real { return last; }});
    return ranges;
}

/// Except for a steep law, strong damping or close breaks the fastest time scale is about 0.1: the error of a step is
/// (0.01/0.1)^9 of its small change.
real MixedTruth::longest_step() const {
    constexpr real least_steps = 24;  // from one break to the next
    real longest = breaks_.empty() ? 0.01L : std::min(0.01L, (*breaks_.begin() - since_) / least_steps);
    if (way_ == 0) return longest;
    longest = std::min(longest, 0.05L * s_.I / s_.sliding[range_].steep);
    return s_.C > 0 ? std::min(longest, 0.1L * s_.I / s_.C) : longest;
}

MixedTruth::MixedTruth(MixedSystem system, const MixedPoint& start, real t_end, std::vector<double> times)
    : s_(std::move(system)), y_(start), start_(start) {
    if (s_.relay_of) on_ = (s_.off > s_.on ? 1 : -1) * (s_.off - s_.relay_of(0, y_)) >= 0;
    if (s_.when) half_ = sign(s_.when(0, y_));
    for (const real b : s_.breaks) breaks_.insert(b);
    if (s_.delayed) {
        for (int i = 1; i <= 4; ++i) {
            breaks_.insert(s_.by * i);
            for (const real b : s_.breaks) breaks_.insert(b + s_.by * i);
        }
    }
    take_samples();
    slide(sign(slip(0, y_)));
    if (way_ == 0) settle(false);
    for (long steps = 0; t_ < t_end && !doubtful; ++steps) {
        while (!breaks_.empty() && *breaks_.begin() <= t_) {
            since_ = *breaks_.begin();
            breaks_.erase(breaks_.begin());
        }
        real end = std::min(t_end, t_ + longest_step());
        if (!breaks_.empty()) end = std::min(end, *breaks_.begin());
        if (s_.sampled) end = std::min(end, s_.every * static_cast<real>(instant_));
        if (!pending_.empty()) end = std::min(end, pending_.front().first);
        if (end - t_ < 1e-15L && end < t_end) end = t_ + 1e-15L;
        real h = end - t_;
        while (s_.bends && h > 1e-9L && !is_resolved(h)) h /= 2, end = t_ + h;
        int what = nothing;
        bool found = false;
        for (const real part : {h / 2, h}) {
            if (!happens(part, what)) continue;
            real a = 0, b = part;
            for (int i = 0; i < 70; ++i) {
                int here = nothing;
                const real m = (a + b) / 2;
                if (happens(m, here)) {
                    b = m, what = here;
                } else {
                    a = m;
                }
            }
            h = b, found = true;
            break;
        }
        while (motions.size() < times.size() && static_cast<real>(times[motions.size()]) < t_ + h) {
            motions.push_back(stepped(t_, y_, static_cast<real>(times[motions.size()]) - t_));
        }
        const MixedPoint next = stepped(t_, y_, h);
        if (s_.delayed && h > 0) {
            past_.push_back({t_, h, y_, next, slope(t_, y_).velocity, slope(t_ + h, next).velocity});
        }
        t_ = found ? t_ + h : end;
        y_ = next;
        fresh_ = false;
        const auto coming = breaks_.upper_bound(t_);
        middle_ = t_ + longest_step() / 2;
        if (coming != breaks_.end()) middle_ = std::min(middle_, (t_ + *coming) / 2);
        if (way_ == 0) y_.velocity = wall_ != 0 ? 0 : belt(t_);
        if (found) {
            if (s_.delayed) {
                for (int i = 1; i <= 3; ++i) breaks_.insert(t_ + s_.by * i);
            }
            happen(what);
        }
        take_samples();
        if (way_ == 0 && !found) {  // M may have jumped
            const real p = pull(t_, y_);
            if (std::fabs(p) > s_.holding[p > 0 ? 1 : 0] && sign(p) != wall_) happen(lets_go);
        }
        const bool creeps =
            !found && way_ != 0 && is_dry() && std::fabs(slip(t_, y_)) + std::fabs(slope(t_, y_).velocity) < 1e-8L;
        doubtful = doubtful || creeps || !(std::fabs(y_.theta) + std::fabs(y_.velocity) < 1e3L) ||
                   events.size() > 300 || steps > 300000;
    }
    while (motions.size() < times.size()) motions.push_back(y_);
}

/// The state at an earlier time, by quintics between the ends of steps; at jumps on the side of the present step.
MixedPoint MixedTruth::then(real t) const {
    const real inside = t + 1e-9L * (middle_ - s_.by - t);
    if (inside <= 0 || past_.empty()) return start_;
    const auto after =
        std::partition_point(past_.begin(), past_.end(), [inside](const Past& p) { return p.t <= inside; });
    const Past& p = *(after - 1);
    const real h = p.length, s = (t - p.t) / h;
    const real d = p.end.theta - p.begin.theta, v0 = h * p.begin.velocity, v1 = h * p.end.velocity, a0 = h * h * p.a0,
               a1 = h * h * p.a1;
    const real c3 = 10 * d - 6 * v0 - 4 * v1 - (3 * a0 - a1) / 2,
               c4 = -15 * d + 8 * v0 + 7 * v1 + (3 * a0 - 2 * a1) / 2, c5 = 6 * d - 3 * (v0 + v1) - (a0 - a1) / 2;
    return {p.begin.theta + s * (v0 + s * (a0 / 2 + s * (c3 + s * (c4 + s * c5)))),
            (v0 + s * (a0 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h, 0};
}

/// All torques except friction, damping and those of the moving frame.
real MixedTruth::torque(real t, const MixedPoint& y) const {
    real M = s_.M(t, y);
    if (s_.broken) M += s_.broken(t, middle_, y);
    if (s_.sampled) M += output_;
    if (s_.relay_of) M += s_.levels[on_ ? 0 : 1];
    if (s_.delayed) M += s_.delayed(t, then(t - s_.by));
    if (s_.base) M -= s_.I * s_.base(t);
    return M - s_.k * y.theta - s_.spring(y.theta);
}

real MixedTruth::pull(real t, const MixedPoint& y) const {
    if (wall_ != 0 || !s_.belt) return torque(t, {y.theta, 0, y.z});
    return torque(t, {y.theta, belt(t), y.z}) - s_.I * s_.belt_rate(t) - s_.C * belt(t);
}

MixedPoint MixedTruth::slope(real t, const MixedPoint& y) const {
    if (way_ == 0) {
        const real v = wall_ != 0 ? 0 : belt(t);
        return {v, wall_ != 0 || !s_.belt_rate ? 0 : s_.belt_rate(t), s_.rate(t, {y.theta, v, y.z})};
    }
    const real w = static_cast<real>(way_);
    return {y.velocity, (torque(t, y) - w * s_.sliding[range_].torque(way_, w * slip(t, y)) - s_.C * y.velocity) / s_.I,
            s_.rate(t, y)};
}

/// Returns whether a step leads to where its halves lead: it passes no corner.
bool MixedTruth::is_resolved(real h) const {
    const MixedPoint whole = stepped(t_, y_, h), halves = stepped(t_ + h / 2, stepped(t_, y_, h / 2), h / 2);
    return std::fabs(whole.theta - halves.theta) + std::fabs(whole.velocity - halves.velocity) < 1e-15L;
}

MixedPoint MixedTruth::stepped(real from, const MixedPoint& y, real h) const {
    using P = std::array<real, 3>;
    middle_ = from + h / 2;
    if (!(h > 0)) return y;
    P p{y.theta, y.velocity, y.z};
    boost::numeric::odeint::runge_kutta_fehlberg78<P, real>().do_step(
        [&](const P& q, P& dq, real t) {
            const MixedPoint d = slope(t, {q[0], q[1], q[2]});
            dq = {d.theta, d.velocity, d.z};
        },
        p, from, h);
    return {p[0], p[1], p[2]};
}

/// Returns whether a step of this length contains an event, and which.
bool MixedTruth::happens(real h, int& what) const {
    const MixedPoint y = stepped(t_, y_, h);
    const real t = t_ + h;
    what = nothing;
    if (way_ != 0 && static_cast<real>(way_) * slip(t, y) < 0) {
        if (!fresh_ || h > 1e-9L) what = stands;
    } else if (way_ != 0) {
        const real speed = static_cast<real>(way_) * slip(t, y);
        if (speed > s_.sliding[range_].to || (range_ > 0 && speed < s_.sliding[range_ - 1].to)) what = corner;
    }
    if (way_ == 0) {
        const real p = pull(t, y);
        if (std::fabs(p) > s_.holding[p > 0 ? 1 : 0] && sign(p) != wall_) what = lets_go;
    }
    if (s_.walls && wall_ == 0 && (y.theta > s_.upper || y.theta < s_.lower)) what = hits;
    if (s_.relay_of && what == nothing) {
        const real w = s_.off > s_.on ? 1 : -1, x = s_.relay_of(t, y);
        if ((on_ ? w * (s_.off - x) : w * (x - s_.on)) < 0) what = switches;
    }
    if (s_.when && half_ < 0 && what == nothing && s_.when(t, y) > 0) what = user;
    return what != nothing;
}

void MixedTruth::happen(int what) {
    switch (what) {
        case stands:
            y_.velocity = belt(t_);
            settle(true);
            break;
        case lets_go:
            slide(sign(pull(t_, y_)));
            fresh_ = true;
            wall_ = 0;
            if (is_dry()) tell("slip");
            break;
        case hits: {
            const int side = y_.theta > (s_.lower + s_.upper) / 2 ? 1 : -1;
            y_.theta = side > 0 ? s_.upper : s_.lower;
            tell("impact");
            if (std::fabs(y_.velocity) < 1e-3L) doubtful = true;
            y_.velocity *= -s_.restitution;
            if (s_.restitution == 0) {
                way_ = 0, wall_ = side;
                if (s_.belt) doubtful = true;  // sliding along a mass at a wall is not covered
                const real p = pull(t_, y_);
                if (sign(p) == -side && std::fabs(p) > s_.holding[p > 0 ? 1 : 0]) {
                    doubtful = true;  // pulled off at once
                } else {
                    tell("stick");
                }
            } else {
                slide(sign(slip(t_, y_)));
            }
            break;
        }
        case corner:
            ++corners_passed;
            slide(way_);
            break;
        case switches:
            on_ = !on_;
            tell("switch");
            if (way_ == 0) {
                const real p = pull(t_, y_);
                if (std::fabs(p) > s_.holding[p > 0 ? 1 : 0] && sign(p) != wall_) happen(lets_go);
            }
            break;
        default:
            half_ = 1;
            tell("user");
            if (s_.kept_velocity != 1) {
                // Small bounces and grazing contacts depend on rounding.
                if (std::fabs(y_.velocity) < 0.1L) doubtful = true;
                y_.velocity *= s_.kept_velocity;
                wall_ = 0;
                slide(sign(slip(t_, y_)));
                if (way_ == 0) settle(true);
            }
    }
    if (s_.when && half_ >= 0 && s_.when(t_, y_) < -1e-12L) half_ = -1;
}

void MixedTruth::settle(bool tell_stick) {
    const real p = pull(t_, y_);
    const int towards = std::fabs(p) > s_.holding[p > 0 ? 1 : 0] ? sign(p) : 0;
    if (tell_stick && towards == 0) tell("stick");
    if (tell_stick && towards != 0 && towards != way_) tell("turn");
    slide(towards);
    fresh_ = way_ != 0;
}

void MixedTruth::slide(int way) {
    way_ = way;
    range_ = 0;
    while (std::fabs(slip(t_, y_)) >= s_.sliding[range_].to) ++range_;
}

void MixedTruth::take_samples() {
    if (s_.when && half_ >= 0 && s_.when(t_, y_) < -1e-12L) half_ = -1;
    if (!s_.sampled) return;
    const auto take = [&] {
        while (!pending_.empty() && pending_.front().first <= t_) {
            output_ = pending_.front().second;
            pending_.pop_front();
        }
    };
    take();
    while (s_.every * static_cast<real>(instant_) <= t_) {
        pending_.emplace_back(s_.every * static_cast<real>(instant_) + s_.delay, s_.sampled(t_, y_));
        ++instant_;
    }
    take();
}

}  // namespace dinal::truth
