#include "motion/exact/free_motion.hpp"

#include <cmath>

namespace dinal::motion::exact {

LinearMotion::LinearMotion(const model::Lowered& system) {
    // Computed once for each run in extended precision: an error of w1 accumulates over ten thousand periods.
    using Real = long double;
    const Real I = system.inertia(), k = system.stiffness(), C = system.damping();
    const Real delta = C / (2 * I), square = k / I;
    const Real w0 = std::sqrt(square), difference = (w0 - delta) * (w0 + delta), w1 = std::sqrt(std::fabs(difference));
    delta_ = static_cast<double>(delta);
    w0_ = static_cast<double>(w0);
    w0_squared_ = static_cast<double>(square);
    w1_ = static_cast<double>(w1);
    w1_rest_ = static_cast<double>(w1 - w1_);
    swings_ = difference > 0;
    fast_ = static_cast<double>(swings_ ? delta : delta + w1);
    slow_ = static_cast<double>(swings_ ? delta : square / (delta + w1));
    fastest_ = swings_ ? w0_ : fast_;
    constexpr double far_apart = 4;
    apart_ = !swings_ && fast_ >= far_apart * slow_;
    by_first_ = apart_ ? -slow_ : -w0_squared_;
    by_second_ = apart_ ? -fast_ : -2 * delta_;
    // (p, q) of the n-th derivative of the velocity, p w0 theta + q velocity in units of w0^n.
    const double twice_zeta = 2 * delta_ / w0_;
    double p = 0, q = 1;
    for (int n = 0; n < 4; ++n) {
        const double next = p - twice_zeta * q;
        p = -q;
        q = next;
    }
    energy_fourth_ = std::hypot(p, q) * w0_squared_ * w0_squared_;
}

FreeStep LinearMotion::after(double tau) const {
    const double x = w1_ * tau;
    if (swings_) return step(turned(tau));
    if (x < 0.5) {  // critical or nearly so: the same formula below and above
        const double fade = std::exp(-delta_ * tau);
        const double moved = x == 0 ? fade * tau : fade * tau * (std::sinh(x) / x);
        const double c = fade * (x == 0 ? 1 : std::cosh(x));
        return {c + delta_ * moved, moved, c - delta_ * moved};
    }
    const double slow = std::exp(-slow_ * tau), fast = std::exp(-fast_ * tau), apart = 2 * w1_;
    return {(fast_ * slow - slow_ * fast) / apart, (slow - fast) / apart, (fast_ * fast - slow_ * slow) / apart};
}

FreeParts LinearMotion::parts(double theta, double velocity) const {
    if (!apart_) return {theta, velocity};
    const double between = fast_ - slow_;
    return {-slow_ * (velocity + fast_ * theta) / between, fast_ * (velocity + slow_ * theta) / between};
}

FreeStep LinearMotion::parts_after(double tau) const {
    if (!apart_) return after(tau);
    return {std::exp(-slow_ * tau), 0, std::exp(-fast_ * tau)};
}

double LinearMotion::fourth_bound(const FreeParts& at) const {
    // The energy of a free motion does not grow.
    if (!apart_) return energy_fourth_ * (std::fabs(w0_ * at.first) + std::fabs(at.second));
    const double slow_square = slow_ * slow_, fast_square = fast_ * fast_;
    return std::fabs(at.first) * (slow_square * slow_square) + std::fabs(at.second) * (fast_square * fast_square);
}

std::complex<double> LinearMotion::turned(double tau) const {
    const double x = w1_ * tau, small = std::fma(w1_, tau, -x) + w1_rest_ * tau;
    const double fade = delta_ == 0 ? 1 : std::exp(-delta_ * tau);
    const double s = std::sin(x), c = std::cos(x);
    return {fade * (c - small * s), fade * (s + small * c)};
}

}  // namespace dinal::motion::exact
