#include "support/oracle.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>

#include "support/crossing.hpp"

namespace dinal::truth {

namespace {

namespace odeint = boost::numeric::odeint;
using Point = std::array<real, 2>;
using Fehlberg = odeint::runge_kutta_fehlberg78<Point, real>;

/// Steps for each radian of the fastest oscillation: between two of them a velocity has at most one extreme.
constexpr real steps_per_radian = 4;
constexpr real least_steps = 12;  // for each stretch
constexpr long most_steps = 30000;
constexpr real most_growth = 1e6;
constexpr std::size_t most_events = 5000;

}  // namespace

Oracle::Oracle(const model::Oscillator& system, Load load, const model::State& initial, const motion::Window& window,
               double size, std::vector<double> times, real tolerance)
    : system_(system),
      load_(std::move(load)),
      size_(size),
      k_(system.stiffness()),
      w0_(std::sqrt(static_cast<real>(system.stiffness()) / static_cast<real>(system.inertia()))),
      Re_{system.friction().holding(model::Motion::backward), system.friction().holding(model::Motion::forward)},
      Rd_{system.friction().sliding(model::Motion::backward, 0), system.friction().sliding(model::Motion::forward, 0)},
      t_start_(window.start),
      t_end_(window.end),
      longest_(1 / (steps_per_radian * std::max<real>(1, static_cast<real>(load_.quickest) / w0_))),
      tolerance_(tolerance),
      times_(std::move(times)),
      t_(window.start),
      y_{static_cast<real>(initial.theta) / size_, static_cast<real>(initial.velocity) / (w0_ * size_)} {
    sign_ = y_[1] > 0 ? 1 : y_[1] < 0 ? -1 : 0;
    largest_ = std::max(std::fabs(y_[0]), std::fabs(y_[1])) * size_;
    std::vector<real> ends;
    for (const double b : load_.breaks) {
        if (b > window.start && b < window.end) ends.push_back(b);
    }
    ends.push_back(t_end_);
    for (const real to : ends) {
        if (!gave_up_) pass({t_, to, t_ + (to - t_) / 2});
    }
    while (motions_.size() < times_.size()) motions_.push_back({y_[0] * size_, y_[1] * size_ * w0_});
}

/// Integrates from one break of M to the next.
void Oracle::pass(const Stretch& stretch) {
    if (sign_ == 0 && dry()) {
        sign_ = from_standstill(stretch);
        if (sign_ != 0) note(model::EventKind::slip, 1);
    }
    while (t_ < stretch.to && !gave_up_) {
        sign_ == 0 && dry() ? wait(stretch) : move(stretch);
        gave_up_ = gave_up_ || steps_ > most_steps || events_.size() > most_events;
    }
}

real Oracle::torque(const Stretch& stretch, real t, const Motion& y) const {
    return load_.torque(t, stretch.inside, y);
}

void Oracle::slope(const Stretch& stretch, const Point& y, Point& dy, real tau) const {
    const Motion motion{y[0] * size_, y[1] * size_ * w0_};
    const real M = torque(stretch, stretch.from + tau / w0_, motion);
    const real C = system_.damping();
    dy[0] = y[1];
    dy[1] = (M - static_cast<real>(sign_) * of(Rd_, sign_) - C * motion.velocity - k_ * motion.theta) / (k_ * size_);
}

Oracle::Point Oracle::part_of(const Stretch& stretch, const Step& step, real length) const {
    Point y = step.begin;
    if (length > 0) {
        const auto f = [&](const Point& p, Point& dp, real tau) { slope(stretch, p, dp, tau); };
        Fehlberg().do_step(f, y, step.from, length);
    }
    return y;
}

/// Steps up to the next standstill or the end of the stretch.
void Oracle::move(const Stretch& stretch) {
    const real end = (stretch.to - stretch.from) * w0_;
    real tau = (t_ - stretch.from) * w0_;
    const real longest = std::min(longest_, end / least_steps);
    real h = 1e-3L * longest;
    while (tau < end && ++steps_ <= most_steps) {
        const bool last = tau + h >= end;
        Step step{y_, tau, last ? end - tau : h, {}};
        const real half = step.length / 2;
        const Point once = part_of(stretch, step, step.length);
        step.end = part_of(stretch, {part_of(stretch, step, half), tau + half, half, {}}, half);
        // Fehlberg's own estimate only uses both ends of a step, and would miss corners between them.
        const real error = std::max(std::fabs(step.end[0] - once[0]), std::fabs(step.end[1] - once[1]));
        const real excess = error / (tolerance_ * (1 + std::fabs(step.end[0]) + std::fabs(step.end[1])));
        h = std::min(longest, step.length * std::clamp<real>(0.8L * std::pow(excess, -1 / 8.0L), 0.1L, 4));
        if (!(excess <= 1)) continue;
        largest_ = std::max({largest_, std::fabs(step.end[0]) * size_, std::fabs(step.end[1]) * size_});
        gave_up_ = gave_up_ || !(largest_ < most_growth * size_);
        if (gave_up_ || look_for_standstill(stretch, step)) return;
        Point dy{};
        slope(stretch, step.end, dy, tau + step.length);
        if (sign_ != 0) close_call(std::max(std::fabs(dy[0]), std::fabs(dy[1])));  // it creeps towards a balance
        tell_until(stretch, step, step.length);
        y_ = step.end;
        tau = last ? end : tau + step.length;
        t_ = last ? stretch.to : stretch.from + tau / w0_;
    }
}

bool Oracle::look_for_standstill(const Stretch& stretch, const Step& step) {
    if (sign_ == 0) {  // without friction, from rest
        sign_ = step.end[1] > 0 ? 1 : step.end[1] < 0 ? -1 : 0;
        return false;
    }
    const real s = static_cast<real>(sign_);
    const auto velocity = [&](real length) { return s * part_of(stretch, step, length)[1]; };
    const auto rising = [&](real length) {
        Point dy{};
        slope(stretch, part_of(stretch, step, length), dy, step.from + length);
        return s * dy[1];
    };
    real a = 0, fa = s * step.begin[1];
    real b = step.length, fb = s * step.end[1];
    if (fa <= 0) {  // it has just left zero: find where it is visible
        a = b, fa = fb;
        while (fa <= 0 && a > 1e-15L) a /= 2, fa = velocity(a);
        if (fa <= 0) {
            close_call(0);
            stand_still(stretch, step, a);
            return true;
        }
        if (fb > 0) return false;
    } else if (fb > 0) {
        if (!(rising(0) < 0 && rising(b) > 0)) return false;
        b = crossing([&](real x) { return -rising(x); }, a, b);
        fb = velocity(b);
        close_call(fb);
        if (fb > 0) return false;
    }
    stand_still(stretch, step, smooth_crossing(velocity, a, fa, b, fb));
    return true;
}

void Oracle::stand_still(const Stretch& stretch, const Step& step, real length) {
    tell_until(stretch, step, length);
    const Point y = part_of(stretch, step, length);
    Point dy{};
    slope(stretch, y, dy, step.from + length);
    const bool at_end = step.from + length >= (stretch.to - stretch.from) * w0_;
    t_ = at_end ? stretch.to : stretch.from + (step.from + length) / w0_;
    y_ = {y[0], 0};
    const int before = sign_;
    if (dry()) {
        sign_ = from_standstill(stretch);
        for (const double b : load_.breaks) close_call(std::fabs(t_ - b) * w0_);
        close_call((t_end_ - t_) * w0_);
    } else {
        sign_ = -before;
    }
    if (sign_ != before) note(sign_ == 0 ? model::EventKind::stick : model::EventKind::turn, std::fabs(dy[1]));
}

int Oracle::from_standstill(const Stretch& stretch) {
    const real net = torque(stretch, t_, {y_[0] * size_, 0}) - k_ * y_[0] * size_;
    const int towards = net > 0 ? 1 : -1;
    close_call((std::fabs(net) - of(Re_, towards)) / (k_ * size_));
    return std::fabs(net) <= of(Re_, towards) ? 0 : towards;
}

/// Waits for a release or the end of the stretch.
void Oracle::wait(const Stretch& stretch) {
    const real theta = y_[0] * size_;
    real begin = t_, released = stretch.to;
    int direction = 0;
    for (const int side : {1, -1}) {
        const auto left = [&](real t) {
            return of(Re_, side) - static_cast<real>(side) * (torque(stretch, t, {theta, 0}) - k_ * theta);
        };
        const real step = std::min(longest_ / w0_, (stretch.to - stretch.from) / least_steps);
        real x0 = begin, f0 = left(x0), x1 = x0, f1 = f0;  // the last two points
        for (long i = 1; x1 < stretch.to; ++i) {
            const real x = std::min(begin + static_cast<real>(i) * step, stretch.to), f = left(x);
            real found = model::never;
            if (f <= 0) {
                found = crossing(left, x1, x);
            } else if (f1 < f0 && f1 < f) {
                const real lowest = least(left, x0, x);
                close_call(left(lowest) / (k_ * size_));
                if (left(lowest) <= 0) found = crossing(left, x0, lowest);
            }
            if (found < model::never) {
                if (found < released || direction == 0) released = found, direction = side;
                break;
            }
            x0 = x1, f0 = f1, x1 = x, f1 = f;
        }
        close_call(f1 / (k_ * size_));
    }
    for (; motions_.size() < times_.size() && times_[motions_.size()] < released;) motions_.push_back({theta, 0});
    t_ = released;
    if (direction == 0) return;
    sign_ = direction;
    const real dt = 1e-6L * longest_ / w0_;
    const real before = torque(stretch, t_ - dt, {theta, 0}), after = torque(stretch, t_ + dt, {theta, 0});
    note(model::EventKind::slip, std::fabs(after - before) / (2 * dt) / (w0_ * k_ * size_));
}

void Oracle::note(model::EventKind kind, real sharpness) {
    if (t_ > t_start_) events_.push_back({t_, kind, y_[0] * size_, sharpness});
}

void Oracle::tell_until(const Stretch& stretch, const Step& step, real length) {
    while (motions_.size() < times_.size()) {
        const real tau = (static_cast<real>(times_[motions_.size()]) - stretch.from) * w0_ - step.from;
        if (tau > length) break;
        const Point y = part_of(stretch, step, tau);
        motions_.push_back({y[0] * size_, y[1] * size_ * w0_});
    }
}

void Oracle::close_call(real margin) {
    narrowest_ = std::min(narrowest_, std::fabs(margin));
}

}  // namespace dinal::truth
