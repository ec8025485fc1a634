#include "motion/exact/arc.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal::motion::exact {

namespace {

/// Up to so many radians of its fastest part a motion is told by its Taylor series.
constexpr double short_of = 0.3;
/// What a sum may lose by cancellation before it is told otherwise: some digits of sixteen.
constexpr double most_cancelled = 256;
/// Nearer than this part of k to resonance a sine is told relative to the resonant motion.
constexpr double near_resonance = 1.0 / 64;

}  // namespace

double Arc::fastest_rate(const model::ClosedForm& M) const {
    return std::max(free_.fastest(), M.fastest());
}

double Arc::begin(const model::ClosedForm& M, const Start& start, double length) {
    const double rate = fastest_rate(M);
    if (rate * length > short_of) {
        if (begin_closed(M, start, length)) {
            velocity_.begin();
            return length;
        }
        length = short_of / rate;
    }
    begin_series(M, start, length, rate);
    velocity_.begin();
    return length;
}

/// Particular solutions, and the free motion that is left. False when they would cancel.
bool Arc::begin_closed(const model::ClosedForm& M, const Start& start, double length) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness();
    velocity_.clear();
    double theta = 0, velocity = start.velocity;  // of the free motion

    // Powers: from the highest down, k b_n = c_n - C (n + 1) b_(n+1) - I (n + 2) (n + 1) b_(n+2).
    way_.assign(M.powers().begin(), M.powers().end());
    way_[0] = start.pull;
    for (const double q : M.quadrature()) way_[0] -= q;
    for (const double a : M.amount()) way_[0] -= a;
    const double span = std::min(length, 2 * std::numbers::pi / free_.w0());
    double load = 0;
    for (std::size_t i = way_.size(); i-- > 0;) load = load * span + std::fabs(way_[i]);
    for (std::size_t i = way_.size(); i-- > 0;) {
        const auto n = static_cast<double>(i);
        if (i + 1 < way_.size()) way_[i] -= C * (n + 1) * way_[i + 1];
        if (i + 2 < way_.size()) way_[i] -= I * (n + 2) * (n + 1) * way_[i + 2];
        way_[i] /= k;
    }
    if (way_.size() > 1 && k * (std::fabs(way_[0]) + std::fabs(way_[1]) / free_.w0()) > most_cancelled * load) {
        return false;
    }
    for (std::size_t i = 0; i < way_.size(); ++i) {
        velocity_.add_way_power(way_[i]);
        if (i > 0) velocity_.add_power(static_cast<double>(i) * way_[i]);
    }
    theta -= way_[0];
    if (way_.size() > 1) velocity -= way_[1];

    for (std::size_t j = 0; j < M.rate().size(); ++j) {
        const double r = M.rate()[j], held = I * r * r + C * r + k;
        if (std::fabs(held) * most_cancelled < I * r * r + C * std::fabs(r) + k) return false;
        const double way = M.amount()[j] / held;
        velocity_.add_exponential(r, r * way);
        theta -= way;
        velocity -= r * way;
    }

    const double w1 = free_.root().imag();
    for (std::size_t j = 0; j < M.omega().size(); ++j) {
        const double omega = M.omega()[j];
        const Complex F{M.in_phase()[j], M.quadrature()[j]}, i(0, 1);
        const Complex held{std::fma(-I * omega, omega, k), C * omega};
        if (free_.swings() && std::abs(held) < near_resonance * k) {
            // (g(mu, lambda) - g(mu, conj lambda)) / (2 i w1 I), of which only the first is near resonance.
            const Complex mu(0, omega), other = std::conj(free_.root());
            const Complex growing = F / (2.0 * i * w1 * I), turning = -growing / (mu - other);
            velocity_.add_resonance({.mu = mu,
                                     .from_root = free_.from_root(omega),
                                     .growing = growing * free_.root(),
                                     .turning = growing + turning * mu,
                                     .way_growing = growing,
                                     .way_turning = turning});
            theta -= turning.imag();
            velocity -= (turning * other).imag();
            continue;
        }
        const Complex way = F / held;
        velocity_.add_sine(omega, i * omega * way);
        theta -= way.imag();
        velocity -= omega * way.real();
    }
    velocity_.add_free(theta, velocity);
    return true;
}

/// The Taylor series of the motion: what is short, or what would cancel, is told by it.
void Arc::begin_series(const model::ClosedForm& M, const Start& start, double length, double rate) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness(), x = rate * length;
    std::size_t order = 2;
    double left = x * x / 2;
    while (left > 1e-18 && order < 40) left *= x / static_cast<double>(++order);
    order = std::max(order, M.powers().size() + 2);

    load_.assign(order, 0.0);
    std::copy(M.powers().begin(), M.powers().end(), load_.begin());
    load_[0] = start.pull;
    for (std::size_t j = 0; j < M.omega().size(); ++j) {
        double p = M.in_phase()[j], q = M.quadrature()[j];
        for (std::size_t n = 1; n < order; ++n) {
            const double by = M.omega()[j] / static_cast<double>(n), next = p * by;
            p = -q * by;
            q = next;
            load_[n] += q;
        }
    }
    for (std::size_t j = 0; j < M.rate().size(); ++j) {
        double a = M.amount()[j];
        for (std::size_t n = 1; n < order; ++n) load_[n] += a *= M.rate()[j] / static_cast<double>(n);
    }
    velocity_.clear();
    way_.assign(order + 2, 0.0);
    way_[1] = start.velocity;
    velocity_.add_way_power(0);
    for (std::size_t i = 0; i < order; ++i) {
        const auto n = static_cast<double>(i);
        way_[i + 2] = (load_[i] - C * (n + 1) * way_[i + 1] - k * way_[i]) / (I * (n + 1) * (n + 2));
        velocity_.add_way_power(way_[i + 1]);
        velocity_.add_power((n + 1) * way_[i + 1]);
    }
    velocity_.add_way_power(way_[order + 1]);
    velocity_.add_power(static_cast<double>(order + 1) * way_[order + 1]);
}

}  // namespace dinal::motion::exact
