#include "theory/forced.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dinal::theory {

namespace {
using std::numbers::pi;
}  // namespace

double magnification(double r, double zeta) {
    return 1 / std::hypot(detuning(r), 2 * zeta * r);
}

double phase_lag(double r, double zeta) {
    return r == 1 ? pi / 2 : std::atan2(2 * zeta * r, detuning(r));
}

// With zeta + zeta_eq instead of zeta, (1 - r^2)^2 Phi^2 + (2 zeta r Phi + g)^2 = 1, g = 4 gamma/pi: the positive root,
// in a form without subtraction.
std::optional<Harmonic_motion> linearised_friction(double r, double zeta, double friction_ratio) {
    const double g = 4 * friction_ratio / pi;
    if (!(g < 1)) return {};
    const double d = detuning(r);
    const double c = 2 * zeta * r;
    const double rest = (1 - g) * (1 + g);
    const double amplitude = rest / (c * g + std::hypot(d * std::sqrt(rest), c));
    if (!std::isfinite(amplitude)) return Harmonic_motion{amplitude, pi / 2};
    return Harmonic_motion{amplitude, std::atan2(c * amplitude + g, d * amplitude)};
}

namespace {

using std::numbers::pi;

/// Quantities of a mode over half a period P for the square wave, each in a form that keeps its digits.
struct HalfPeriod {
    double apart;        // q - r, underdamped
    double pushed;       // g = e^(-zeta P) (sin qP)/q
    double decay;        // 1 - E, E = e^(-zeta P)
    double one_plus;     // E (1 + cos qP)
    double determinant;  // Delta = (1 + 2 E cos qP + E^2)/2
};

/// sin qP and 1 + cos qP vanish where q/r is a whole number n, so they are taken from q/r - n.
HalfPeriod underdamped(const Modes& modes, double r) {
    const double zeta = modes.zeta();
    const double q = modes.rate();
    const double n = std::nearbyint(q / r);
    // For little damping q - n r is computed from 1 - q = zeta^2/(1 + q), as q itself is rounded.
    const auto away = [&](double m) {
        return zeta < 0.3 ? std::fma(-m, r, 1) - zeta * zeta / (1 + q) : std::fma(-m, r, q);
    };
    const double x = pi * (away(n) / r);
    const bool odd = std::fmod(n, 2) != 0;
    const double half = odd ? std::sin(x / 2) : std::cos(x / 2);
    const double decay = -std::expm1(-zeta * pi / r);
    const double E = 1 - decay;
    const double one_plus = 2 * E * half * half;
    return {away(1), E * (odd ? -1 : 1) * std::sin(x) / q, decay, one_plus, decay * decay / 2 + one_plus};
}

HalfPeriod overdamped(const Modes& modes, double r) {
    const double P = pi / r;
    const double decay = -std::expm1(-modes.zeta() * P);
    const double E = 1 - decay;
    const double cosine = modes.damped_cosine(P);
    return {0, modes.pushed(P), decay, E + cosine, (1 + E * E) / 2 + cosine};
}

/// -Y Delta = (1 - E^2)/2 - zeta g, in a form that does not cancel.
double lag_of_square(const Modes& modes, const HalfPeriod& half, double P) {
    const double zeta = modes.zeta();
    const double a = zeta * P;
    if (P < 1 && a < 1) {
        // sinh a - zeta (sinh b)/b P with b^2 = a^2 - P^2: a P^2 sum of (a^2n - b^2n)/(a^2 - b^2)/(2n + 1)!
        const double b2 = a * a - P * P;
        double complete = 1, power = 1, factor = 1.0 / 6, sum = factor;
        for (int n = 2; n < 12; ++n) {
            power *= b2;
            complete = complete * a * a + power;
            factor /= 2 * n * (2 * n + 1);
            sum += complete * factor;
        }
        return std::exp(-a) * a * P * P * sum;
    }
    if (modes.swings()) return -std::expm1(-2 * a) / 2 - zeta * half.pushed;
    const double slow = modes.slow_root();
    return -(1 + std::exp(-modes.fast_root() * P)) * std::expm1(-slow * P) / 2 - slow * half.pushed;
}

}  // namespace

DenHartog::DenHartog(double r, double zeta) : r_(r), modes_(zeta), half_(pi / r) {
    const HalfPeriod half = modes_.swings() ? underdamped(modes_, r) : overdamped(modes_, r);
    apart_ = half.apart;
    angle_ = -lag_of_square(modes_, half, half_) / half.determinant;
    velocity_ = -half.pushed / half.determinant;
    sine_ = (half.decay + half.one_plus) / half.determinant;
    if (!modes_.swings()) sine_ = (1 + modes_.damped_cosine(half_)) / half.determinant;
}

bool DenHartog::grows() const {
    return r_ == 1 && modes_.zeta() == 0;
}

/// The velocity of the steady motion must keep its sign for half a period after a turn at x = 0. Returns the part of it
/// that is proportional to gamma, divided by gamma r sin rx; gamma times this must stay below the rest, which is the
/// constant `swing`.
double DenHartog::velocity_excess(double x) const {
    const double zeta = modes_.zeta();
    const double q = modes_.rate();
    double difference = 0;  // cos rx - e^(-zeta x) cos qx
    if (modes_.swings()) {
        const double cosines = 2 * std::sin((q + r_) * x / 2) * std::sin(apart_ * x / 2);
        difference = std::exp(-zeta * x) * (std::expm1(zeta * x) * std::cos(r_ * x) + cosines);
    } else {
        const double half = std::sin(r_ * x / 2);
        difference = -(std::expm1(-modes_.slow_root() * x) + std::expm1(-modes_.fast_root() * x)) / 2 - 2 * half * half;
    }
    return (sine_ * modes_.pushed(x) - velocity_ * difference) / (r_ * std::sin(r_ * x));
}

/// The excess at the turn itself, where the mass must leave towards the other side against `breakaway`.
double DenHartog::excess_at_turn(double friction, double breakaway) const {
    return (breakaway - friction * (angle_ + 2 * modes_.zeta() * velocity_)) / (r_ * r_);
}

double DenHartog::refined_peak(double from, double to) const {
    constexpr double golden = 0.6180339887498949;
    double left = to - golden * (to - from), right = from + golden * (to - from);
    double at_left = velocity_excess(left), at_right = velocity_excess(right);
    for (int i = 0; i < 45; ++i) {  // to 4e-10 of the width; the peak is flat, so its height is accurate to rounding
        if (at_left > at_right) {
            to = right, right = left, at_right = at_left;
            left = to - golden * (to - from), at_left = velocity_excess(left);
        } else {
            from = left, left = right, at_left = at_right;
            right = from + golden * (to - from), at_right = velocity_excess(right);
        }
    }
    return std::max(at_left, at_right);
}

/// The maximum over the half period, including its beginning. Samples are as dense as mode and load require, and denser
/// if a fast mode decays just after the turn.
double DenHartog::greatest_excess() const {
    const double widest = std::min(half_ / 64, 2 * pi / 32);
    constexpr double nearly = 0.03;  // by how much a peak may exceed the best sample
    double best = excess_at_turn(1, 1);
    constexpr double least = 1e-300;  // the fast root may be infinite, and x must grow
    double before = 0, x = std::max(1e-3 * std::min(widest, 1 / modes_.fast_root()), least);
    double value_before = best, value = velocity_excess(x);
    while (x < half_) {
        const double after = x + std::min(x / 4, widest);
        const double value_after = after < half_ ? velocity_excess(after) : -std::numeric_limits<double>::infinity();
        if (value >= value_before && value > value_after && value > best - nearly * std::fabs(best)) {
            best = std::max({best, value, refined_peak(before, std::min(after, half_))});
        }
        before = x, value_before = value;
        x = after, value = value_after;
    }
    return best;
}

SlidingMotion DenHartog::sliding(double friction_ratio, double swing) const {
    SlidingMotion y;
    y.amplitude = friction_ratio * angle_ + swing;
    const double viscous = phase_lag(r_, modes_.zeta());
    y.lag = viscous + std::atan2(friction_ratio * velocity_ / r_, swing);
    // The fundamental is the response to load and the square wave's fundamental, 4 gamma/pi with a phase of a quarter
    // period.
    const double g = 4 * friction_ratio / pi;
    const double across = g * std::cos(y.lag), along = 1 - g * std::sin(y.lag);
    y.fundamental_amplitude = magnification(r_, modes_.zeta()) * std::hypot(across, along);
    y.fundamental_lag = viscous + std::atan2(across, along);
    return y;
}

// swing = sqrt(Phi^2 - (gamma Y'/r)^2) is amplitude - gamma Y: the harmonic part at the turn.
/// The swing of a motion without stops if it is beyond this; otherwise none.
std::optional<double> DenHartog::swing_beyond(double least, double friction_ratio) const {
    const double phi = magnification(r_, modes_.zeta());
    const double lost = friction_ratio * std::fabs(velocity_) / r_;
    const double swing = std::sqrt(phi - lost) * std::sqrt(phi + lost);
    return lost < phi && swing > least ? std::optional(swing) : std::nullopt;
}

std::optional<SlidingMotion> DenHartog::motion(double friction_ratio, double breakaway_ratio) const {
    if (r_ == 0) {
        if (breakaway_ratio > 0) return {};
        return SlidingMotion{1, 0, 1, 0};
    }
    if (grows()) {
        if (!(friction_ratio < pi / 4)) return {};
        constexpr double unbounded = std::numeric_limits<double>::infinity();
        return SlidingMotion{unbounded, pi / 2, unbounded, pi / 2};
    }
    const auto swing = swing_beyond(excess_at_turn(friction_ratio, breakaway_ratio), friction_ratio);
    if (!swing || !(*swing > friction_ratio * greatest_excess())) return {};
    return sliding(friction_ratio, *swing);
}

std::optional<SlidingMotion> DenHartog::without_stops(double friction_ratio) const {
    if (r_ == 0 || grows()) return {};
    const auto swing = swing_beyond(excess_at_turn(friction_ratio, friction_ratio), friction_ratio);
    return swing ? std::optional(sliding(friction_ratio, *swing)) : std::nullopt;
}

double DenHartog::stop_boundary(double breakaway_factor) const {
    if (r_ == 0) return 0;
    if (grows()) return pi / 4;
    const double excess = std::max(greatest_excess(), excess_at_turn(1, breakaway_factor));
    return magnification(r_, modes_.zeta()) / std::hypot(excess, velocity_ / r_);
}

}  // namespace dinal::theory
