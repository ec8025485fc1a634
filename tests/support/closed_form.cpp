#include "support/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "support/crossing.hpp"

namespace dinal::truth {

namespace {

constexpr real two_pi = 6.283185307179586476925286766559005768L;

real sinc(real x) {
    return std::fabs(x) < 1e-9L ? 1 - x * x / 6 : std::sin(x) / x;
}

real value(const Drive& d, real t) {
    return d.level + d.slope * t + d.amplitude * std::sin(d.omega * t + d.phase);
}

real derivative(const Drive& d, real t) {
    return d.slope + d.amplitude * d.omega * std::cos(d.omega * t + d.phase);
}

/// The first t in (a, b] at which f, positive just after a, reaches zero, given its derivative and a length within
/// which the derivative changes sign at most once.
template <class F, class G>
std::optional<real> first_descent(F&& f, G&& df, real a, real b, real step) {
    real left = a;
    for (long i = 1; left < b; ++i) {
        const real right = std::min(a + static_cast<real>(i) * step, b);
        if (f(right) <= 0) {
            // The first clearly nonzero point: f(a) itself may be 0 or a rounding below.
            real begin = left;
            for (real x = right; left == a && x - a > 1e-18L * step; x = a + (x - a) / 2) {
                begin = x;
                if (f(x) > 0) break;
            }
            if (left == a && f(begin) <= 0) return a;  // above zero by rounding only
            return crossing(f, begin, right);
        }
        if ((left > a || f(a) > 0) && df(left) < 0 && df(right) > 0) {
            const real low = crossing(df, left, right);
            if (f(low) <= 0) return crossing(f, left, low);
        }
        left = right;
    }
    return {};
}

}  // namespace

Arc::Arc(const model::Oscillator& system, const Drive& drive, int sign, real t0, const Motion& start)
    : I_(system.inertia()),
      C_(system.damping()),
      k_(system.stiffness()),
      w0_(std::sqrt(k_ / I_)),
      b_(C_ / (2 * I_)),
      disc_(b_ * b_ - k_ / I_),
      drive_(drive),
      t0_(t0),
      load_(drive.level + drive.slope * t0 - static_cast<real>(sign) * static_cast<real>(system.kinetic_friction())) {
    q_ = drive.slope / k_;
    p_ = (load_ - C_ * q_) / k_;
    const Motion y = particular(0);
    offset_ = {start.theta - y.theta, start.velocity - y.velocity};
}

Motion Arc::free(real tau, const Motion& y) const {
    real c;  // e^(-b tau) times cosh, 1 or cos
    real s;  // e^(-b tau) times sinh/r, tau or sin/w1
    if (disc_ < 0) {
        const real w1 = std::sqrt(-disc_);
        const real e = std::exp(-b_ * tau);
        c = e * std::cos(w1 * tau);
        s = e * std::sin(w1 * tau) / w1;
    } else if (disc_ == 0) {
        c = std::exp(-b_ * tau);
        s = c * tau;
    } else {
        const real r = std::sqrt(disc_);
        const real slow = std::exp(-(k_ / I_) / (b_ + r) * tau);
        c = slow * (1 + std::exp(-2 * r * tau)) / 2;
        s = -slow * std::expm1(-2 * r * tau) / (2 * r);
    }
    return {y.theta * c + (y.velocity + b_ * y.theta) * s, y.velocity * c - (k_ / I_ * y.theta + b_ * y.velocity) * s};
}

Motion Arc::particular(real tau) const {
    Motion y{p_ + q_ * tau, q_};
    const real A = drive_.amplitude;
    const real w = drive_.omega;
    const real phase = drive_.phase + w * t0_;
    if (A == 0) return y;
    if (C_ == 0) {  // Duhamel's integral from zero, in products that stay exact through resonance
        const real sum = w + w0_;
        const real difference = w - w0_;
        const real f = A * tau / (2 * I_);
        const real slow = sinc(difference * tau / 2);
        const real fast = sinc(sum * tau / 2);
        const real slow_phase = difference * tau / 2 + phase + w0_ * tau;
        const real fast_phase = sum * tau / 2 + phase - w0_ * tau;
        y.theta += f / w0_ * (fast * std::cos(fast_phase) - slow * std::cos(slow_phase));
        y.velocity += f * (slow * std::sin(slow_phase) + fast * std::sin(fast_phase));
    } else {
        const real z = k_ - I_ * w * w;
        const real d = C_ * w;
        const real f = A / (z * z + d * d);
        const real x = w * tau + phase;
        y.theta += f * (z * std::sin(x) - d * std::cos(x));
        y.velocity += f * w * (z * std::cos(x) + d * std::sin(x));
    }
    return y;
}

Motion Arc::at(real t) const {
    const Motion f = free(t - t0_, offset_);
    const Motion p = particular(t - t0_);
    return {f.theta + p.theta, f.velocity + p.velocity};
}

real Arc::acceleration(real t) const {
    const Motion y = at(t);
    const real load = load_ + drive_.slope * (t - t0_) + drive_.amplitude * std::sin(drive_.omega * t + drive_.phase);
    return (load - C_ * y.velocity - k_ * y.theta) / I_;
}

ExactMotion::ExactMotion(const model::Oscillator& system, std::vector<Piece> drives, const model::State& initial,
                         double t_start, double t_end)
    : system_(system), drives_(std::move(drives)), t_start_(t_start) {
    real fastest = std::sqrt(static_cast<real>(system.stiffness()) / static_cast<real>(system.inertia()));
    for (const Piece& piece : drives_) fastest = std::max(fastest, piece.drive.omega);
    scan_ = two_pi / fastest / 64;

    Cursor now{t_start, {initial.theta, initial.velocity}, 0};
    now.sign = now.y.velocity > 0 ? 1 : now.y.velocity < 0 ? -1 : 0;
    for (std::size_t i = 0; i < drives_.size(); ++i) {
        const real until = i + 1 < drives_.size() ? std::min<real>(drives_[i + 1].from, t_end) : t_end;
        if (until <= now.t) continue;
        if (now.sign == 0) {
            now.sign = from_standstill(drives_[i].drive, now.t, now.y.theta);
            if (now.sign != 0 && now.t > t_start_) events_.push_back({now.t, model::EventKind::slip, now.y.theta});
        }
        advance(now, drives_[i].drive, until);
    }
    ends_stuck_ = now.sign == 0;
}

void ExactMotion::advance(Cursor& now, const Drive& drive, real until) {
    while (now.t < until) {
        if (events_.size() > 100000) throw std::logic_error("closed form: events without end");
        if (now.sign == 0) {
            wait(now, drive, until);
        } else {
            move(now, drive, until);
        }
    }
}

void ExactMotion::move(Cursor& now, const Drive& drive, real until) {
    const Arc arc(system_, drive, now.sign, now.t, now.y);
    spans_.push_back({now.t, false, now.y, arc});
    const real s = static_cast<real>(now.sign);
    const auto zero = first_descent([&](real t) { return s * arc.at(t).velocity; },
                                    [&](real t) { return s * arc.acceleration(t); }, now.t, until, scan_);
    if (!zero) {
        now = {until, arc.at(until), now.sign};
        return;
    }
    now.t = *zero;
    now.y = {arc.at(*zero).theta, 0};
    now.sign = from_standstill(drive, now.t, now.y.theta);
    events_.push_back({now.t, now.sign == 0 ? model::EventKind::stick : model::EventKind::turn, now.y.theta});
}

void ExactMotion::wait(Cursor& now, const Drive& drive, real until) {
    const real Re = system_.breakaway();
    const real torque = static_cast<real>(system_.stiffness()) * now.y.theta;
    spans_.push_back({now.t, true, now.y, Arc(system_, drive, 0, now.t, now.y)});
    const auto release = [&](real s) {
        return first_descent([&](real t) { return Re - s * (value(drive, t) - torque); },
                             [&](real t) { return -s * derivative(drive, t); }, now.t, until, scan_);
    };
    // A constant load cannot release what it holds; the limit itself may be met within rounding.
    const bool constant = drive.slope == 0 && (drive.amplitude == 0 || drive.omega == 0);
    const auto up = constant ? std::nullopt : release(1);
    const auto down = constant ? std::nullopt : release(-1);
    if (!up && !down) {
        now.t = until;
        return;
    }
    const bool forward = up && (!down || *up < *down);
    now.t = forward ? *up : *down;
    now.sign = forward ? 1 : -1;
    if (now.t > t_start_) events_.push_back({now.t, model::EventKind::slip, now.y.theta});
}

int ExactMotion::from_standstill(const Drive& drive, real t, real theta) const {
    const real k = system_.stiffness();
    const real load = value(drive, t) - k * theta;
    // Without friction nothing ever sticks; an unloaded mass moves in the direction of the coming load.
    if (system_.breakaway() == 0) return load > 0 || (load == 0 && derivative(drive, t) >= 0) ? 1 : -1;
    // The initial theta is a double, so k theta is known to half a unit in its last place.
    const real slack = t == t_start_ ? 0x1p-53L * std::fabs(k * theta) : 0;
    if (std::fabs(load) - static_cast<real>(system_.breakaway()) <= slack) return 0;
    return load > 0 ? 1 : -1;
}

std::size_t ExactMotion::count(model::EventKind kind) const {
    return static_cast<std::size_t>(
        std::count_if(events_.begin(), events_.end(), [kind](const TrueEvent& event) { return event.kind == kind; }));
}

Motion ExactMotion::at(double t) const {
    auto span = std::upper_bound(spans_.begin(), spans_.end(), static_cast<real>(t),
                                 [](real x, const Span& s) { return x < s.from; });
    if (span != spans_.begin()) --span;
    return span->stuck ? span->held : span->arc.at(t);
}

real ExactMotion::excitation(double t) const {
    auto piece = std::upper_bound(drives_.begin(), drives_.end(), static_cast<real>(t),
                                  [](real x, const Piece& p) { return x < p.from; });
    if (piece != drives_.begin()) --piece;
    return piece == drives_.end() ? 0 : value(piece->drive, t);
}

}  // namespace dinal::truth
