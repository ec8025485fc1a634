#include "support/corner_truth.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <utility>

namespace dinal::truth {

std::vector<CornerRange> lines_through(const std::vector<double>& speed, const std::vector<double>& torque) {
    std::vector<CornerRange> ranges;
    for (std::size_t i = 0; i < speed.size(); ++i) {
        const bool last = i + 1 == speed.size();
        const real v0 = speed[i], T0 = torque[i];
        const real slope = last ? 0 : (static_cast<real>(torque[i + 1]) - T0) / (static_cast<real>(speed[i + 1]) - v0);
        ranges.push_back({v0, last ? HUGE_VALL : static_cast<real>(speed[i + 1]),
                          [=](real v) { return T0 + slope * (v - v0); }, std::fabs(slope)});
    }
    return ranges;
}

CornerTruth::CornerTruth(CornerSystem system, const Motion& start, real t_end, const std::vector<double>& times)
    : s_(std::move(system)), y_{start.theta, start.velocity - s_.belt}, times_(times) {
    sign_ = slip() > 0 ? 1 : slip() < 0 ? -1 : 0;
    if (sign_ == 0) arrive(false);
    enter();
    while (t_ < t_end && events.size() < 4000) sign_ == 0 ? wait(t_end) : move(t_end);
    tell_rows(y_, t_, t_end, true);
}

void CornerTruth::enter() {
    range_ = 0;
    while (std::fabs(slip()) >= s_.law[range_].to) ++range_;
}

real CornerTruth::acceleration(real t, const Point& y) const {
    const real friction = sign_ * s_.law[range_].torque(sign_ * y[1]);
    return (s_.M(t) - friction - s_.C * (y[1] + s_.belt) - s_.k * y[0]) / s_.I;
}

CornerTruth::Point CornerTruth::stepped(const Point& from, real h) const {
    boost::numeric::odeint::runge_kutta_fehlberg78<Point, real> stepper;
    Point y = from;
    const auto slope = [this](const Point& at, Point& rate, real t) { rate = {at[1] + s_.belt, acceleration(t, at)}; };
    stepper.do_step(slope, y, t_, h);
    return y;
}

std::array<real, 3> CornerTruth::inside(const Point& y) const {
    const real speed = sign_ * y[1];
    return {speed - s_.law[range_].from, s_.law[range_].to - speed, s_.wall - y[0]};
}

void CornerTruth::move(real t_end) {
    const CornerRange& law = s_.law[range_];
    const real w = std::max(s_.quickest, std::sqrt(s_.k / s_.I));
    real h = std::min(0.02L / w, 0.05L * s_.I / (s_.C + law.steep + 1e-30L));
    h = std::min(h, 0.05L * law.narrow / (std::fabs(acceleration(t_, y_)) + w * std::fabs(slip()) * 0.02L + 1e-30L));
    h = std::min(h, t_end - t_);
    const auto before = inside(y_);
    const Point whole = stepped(y_, h);
    real length = h;
    int which = -1;
    for (int i = 0; i < 3; ++i) {
        const auto lost = [&](real at) { return !(inside(stepped(y_, at))[static_cast<std::size_t>(i)] > 0); };
        // What begins at zero is leaving it, or goes back at once.
        real low = 0, high = length;
        if (before[static_cast<std::size_t>(i)] <= 0) {
            low = h * 1e-6L;
            if (lost(low)) {
                which = i, length = 0;
                break;
            }
        }
        if (!lost(high)) continue;
        for (int j = 0; j < 200 && high - low > 1e-21L; ++j) {
            const real middle = (low + high) / 2;
            if (middle <= low || middle >= high) break;
            (lost(middle) ? high : low) = middle;
        }
        which = i, length = high;
    }
    const Point end = which < 0 ? whole : stepped(y_, length);
    const Point from = y_;
    tell_rows(from, t_, t_ + length, false);
    y_ = end;
    t_ += length;
    if (which == 2) {
        y_ = {s_.wall, -s_.restitution * (end[1] + s_.belt) - s_.belt};
        tell("impact");
        const int now = slip() > 0 ? 1 : -1;
        sign_ = now;
        enter();
    } else if (which >= 0) {
        const real corner = which == 0 ? s_.law[range_].from : s_.law[range_].to;
        y_[1] = sign_ * corner;
        ++corners_passed;
        if (which == 0 && range_ == 0) {
            arrive(true);
        } else {
            which == 0 ? --range_ : ++range_;
        }
    }
}

void CornerTruth::arrive(bool told) {
    const int before = sign_;
    const real p = pull(t_, y_[0]);
    sign_ = std::fabs(p) <= s_.Re ? 0 : p > 0 ? 1 : -1;
    range_ = 0;
    if (!told) return;
    if (sign_ == 0)
        tell("stick");
    else if (sign_ != before)
        tell("turn");
}

void CornerTruth::wait(real t_end) {
    const real h = std::min(0.01L / s_.quickest, t_end - t_);
    const auto over = [&](real at) { return std::fabs(pull(t_ + at, y_[0] + s_.belt * at)) - s_.Re; };
    real length = h;
    if (over(h) > 0) {
        real low = 0, high = h;
        for (int j = 0; j < 200 && high - low > 1e-21L; ++j) {
            const real middle = (low + high) / 2;
            if (middle <= low || middle >= high) break;
            (over(middle) > 0 ? high : low) = middle;
        }
        length = high;
    }
    tell_rows(y_, t_, t_ + length, false);
    y_[0] += s_.belt * length;
    t_ += length;
    if (over(0) > 0) {
        sign_ = pull(t_, y_[0]) > 0 ? 1 : -1;
        tell("slip");
    }
}

void CornerTruth::tell_rows(const Point& from, real begin, real end, bool all) {
    while (next_ < times_.size() && (all || times_[next_] < end)) {
        const real since = times_[next_] - begin;
        const Point y = all || since <= 0 ? from
                        : sign_ == 0      ? Point{from[0] + s_.belt * since, 0}
                                          : stepped(from, since);
        motions.push_back({y[0], y[1] + s_.belt});
        ++next_;
    }
}

}  // namespace dinal::truth
