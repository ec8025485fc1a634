#include "motion/exact/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace dinal::motion::exact {

namespace {

/// The longest look, in natural periods; each level halves it.
constexpr double longest_look = 8;

/// A product of numbers that are numbers.
Complex times(Complex a, Complex b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
/// The imaginary part of a g + b u.
double imaginary(Complex a, Complex g, Complex b, Complex u) {
    return (a.real() * g.imag() + a.imag() * g.real()) + (b.real() * u.imag() + b.imag() * u.real());
}

}  // namespace

Complex Resonance::difference(double tau, Complex root_turned) const {
    const Complex z = from_root * tau;
    const double size = std::fabs(z.real()) + std::fabs(z.imag());
    if (size < 0.05) {
        // (exp(z) - 1)/z: the term left out is z^3/24, or z^9/10!.
        Complex series = 1;
        for (int n = size < 1e-6 ? 3 : 9; n >= 2; --n) series = 1.0 + times(series, z) / static_cast<double>(n);
        return tau * times(series, root_turned);
    }
    // exp(x + i y) - 1 without a difference of nearly equal numbers.
    const double half = std::sin(z.imag() / 2), grown = std::expm1(z.real());
    const Complex less_one{grown * std::cos(z.imag()) - 2 * half * half, (grown + 1) * std::sin(z.imag())};
    return times(root_turned, less_one) / from_root;
}

void Resonance::prepare(Complex root) {
    // (g exp)' = root g + exp, so that f'''' has growing root^4 of g, and the rest of exp(mu tau).
    const Complex a = root * root, b = mu * mu;
    slope_growing = growing * root;
    slope_turning = growing + turning * mu;
    fourth_growing = std::abs(growing * a * a);
    fourth_turning = std::abs(growing * (a * root + a * mu + root * b + b * mu) + turning * b * b);
}

void WalkedCurve::clear() {
    powers_.clear(), way_powers_.clear();
    omega_.clear(), re_.clear(), im_.clear();
    rate_.clear(), amount_.clear();
    resonances_.clear();
    free_part_ = false;
}

void WalkedCurve::begin() {
    const std::size_t n = omega_.size(), m = rate_.size(), r = resonances_.size();
    const bool same = table_omega_ == omega_ && table_rate_ == rate_ && resonance_mu_.size() == r &&
                      std::equal(resonances_.begin(), resonances_.end(), resonance_mu_.begin(),
                                 [](const Resonance& a, Complex mu) { return a.mu == mu; });
    if (!same || lengths_[0] == 0) {
        table_omega_ = omega_, table_rate_ = rate_;
        resonance_mu_.resize(r);
        for (std::size_t j = 0; j < r; ++j) resonance_mu_[j] = resonances_[j].mu;
        cosine_.resize(levels * n), sine_.resize(levels * n), growth_.resize(levels * m);
        resonance_turn_.resize(levels * r), resonance_difference_.resize(levels * r);
        double length = longest_look * 2 * std::numbers::pi / free_.w0();
        for (int level = 0; level < levels; ++level) {
            lengths_[static_cast<std::size_t>(level)] = length;
            turns_[static_cast<std::size_t>(level)].ready = false;
            length /= 2;
        }
        for (State& state : states_) {
            state.re.resize(n), state.im.resize(n), state.amount.resize(m);
            state.difference.resize(r), state.turned.resize(r);
        }
    }
    now_ = 0;
    State& start = now();
    std::copy(re_.begin(), re_.end(), start.re.begin());
    std::copy(im_.begin(), im_.end(), start.im.begin());
    std::copy(amount_.begin(), amount_.end(), start.amount.begin());
    std::fill(start.difference.begin(), start.difference.end(), Complex(0));
    std::fill(start.turned.begin(), start.turned.end(), Complex(1));
    start.theta = theta_, start.velocity = velocity_;
    for (Resonance& resonance : resonances_) resonance.prepare(free_.root());
    sines_fourth_ = sines_size_ = 0;
    for (std::size_t j = 0; j < n; ++j) {
        const double size = std::fabs(re_[j]) + std::fabs(im_[j]), square = omega_[j] * omega_[j];
        sines_size_ += size;
        sines_fourth_ += size * square * square;
    }
    place_ = 0;
    here_ = sum(start, 0);
}

WalkedCurve::Value WalkedCurve::sum(const State& state, double tau) const {
    Value y;
    for (std::size_t n = powers_.size(); n-- > 0;) {
        y.slope = y.slope * tau + y.f;
        y.f = y.f * tau + powers_[n];
    }
    for (std::size_t j = 0; j < omega_.size(); ++j) {
        y.f += state.im[j];
        y.slope += omega_[j] * state.re[j];
    }
    for (std::size_t j = 0; j < rate_.size(); ++j) {
        y.f += state.amount[j];
        y.slope += rate_[j] * state.amount[j];
    }
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Resonance& r = resonances_[j];
        const Complex g = state.difference[j], u = state.turned[j];
        y.f += imaginary(r.growing, g, r.turning, u);
        y.slope += imaginary(r.slope_growing, g, r.slope_turning, u);
    }
    if (free_part_) {
        y.f += state.velocity;
        y.slope -= free_.w0_squared() * state.theta + 2 * free_.delta() * state.velocity;
    }
    return y;
}

/// The state at tau, from the beginning of the curve.
void WalkedCurve::turn_to(double tau, State& to) const {
    for (std::size_t j = 0; j < omega_.size(); ++j) {
        const double x = omega_[j] * tau, small = std::fma(omega_[j], tau, -x);
        const double s0 = std::sin(x), c0 = std::cos(x), s = s0 + small * c0, c = c0 - small * s0;
        to.re[j] = re_[j] * c - im_[j] * s;
        to.im[j] = re_[j] * s + im_[j] * c;
    }
    for (std::size_t j = 0; j < rate_.size(); ++j) to.amount[j] = amount_[j] * std::exp(rate_[j] * tau);
    if (!resonances_.empty()) {
        const Complex root_turned = free_.turned(tau);
        for (std::size_t j = 0; j < resonances_.size(); ++j) {
            const double omega = resonances_[j].mu.imag(), x = omega * tau, small = std::fma(omega, tau, -x);
            const double s = std::sin(x), c = std::cos(x);
            to.turned[j] = {c - small * s, s + small * c};
            to.difference[j] = resonances_[j].difference(tau, root_turned);
        }
        turn_free(free_.step(root_turned), to);
    } else if (free_part_) {
        turn_free(free_.after(tau), to);
    }
}

void WalkedCurve::turn_free(const FreeStep& step, State& to) const {
    to.theta = step.along * theta_ + step.moved * velocity_;
    to.velocity = step.kept * velocity_ - free_.w0_squared() * step.moved * theta_;
}

double WalkedCurve::way() const {
    const State& state = other();
    double sum = 0;
    for (std::size_t n = way_powers_.size(); n-- > 0;) sum = sum * other_place_ + way_powers_[n];
    for (std::size_t j = 0; j < omega_.size(); ++j) sum -= state.re[j] / omega_[j];
    for (std::size_t j = 0; j < rate_.size(); ++j) sum += state.amount[j] / rate_[j];
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Resonance& r = resonances_[j];
        sum += imaginary(r.way_growing, state.difference[j], r.way_turning, state.turned[j]);
    }
    return free_part_ ? sum + state.theta : sum;
}

const WalkedCurve::Value& WalkedCurve::look_at(double tau) {
    turn_to(tau, next());
    next_place_ = tau;
    return there_ = sum(next(), tau);
}

void WalkedCurve::prepare(int level) {
    const auto i = static_cast<std::size_t>(level);
    const double h = lengths_[i];
    const std::size_t n = omega_.size(), m = rate_.size(), r = resonances_.size();
    for (std::size_t j = 0; j < n; ++j) {
        cosine_[i * n + j] = std::cos(omega_[j] * h);
        sine_[i * n + j] = std::sin(omega_[j] * h);
    }
    for (std::size_t j = 0; j < m; ++j) growth_[i * m + j] = std::exp(rate_[j] * h);
    for (std::size_t j = 0; j < r; ++j) {
        const double x = resonances_[j].mu.imag() * h;
        resonance_turn_[i * r + j] = {std::cos(x), std::sin(x)};
        resonance_difference_[i * r + j] = resonances_[j].difference(h, free_.turned(h));
    }
    turns_[i] = {true, free_.after(h)};
}

const WalkedCurve::Value& WalkedCurve::look(int level) {
    const auto i = static_cast<std::size_t>(level);
    if (!turns_[i].ready) prepare(level);
    const std::size_t n = omega_.size(), m = rate_.size(), r = resonances_.size();
    const double *cosine = cosine_.data() + i * n, *sine = sine_.data() + i * n;
    const State& from = now();
    State& to = next();
    for (std::size_t j = 0; j < n; ++j) {
        const double x = from.re[j], y = from.im[j];
        to.re[j] = x * cosine[j] - y * sine[j];
        to.im[j] = x * sine[j] + y * cosine[j];
    }
    for (std::size_t j = 0; j < m; ++j) to.amount[j] = from.amount[j] * growth_[i * m + j];
    const FreeStep& step = turns_[i].step;
    if (r > 0) {
        // exp(lambda h), from the free motion.
        const Complex root_turned{step.kept + free_.delta() * step.moved, free_.root().imag() * step.moved};
        for (std::size_t j = 0; j < r; ++j) {
            to.difference[j] =
                times(root_turned, from.difference[j]) + times(from.turned[j], resonance_difference_[i * r + j]);
            to.turned[j] = times(from.turned[j], resonance_turn_[i * r + j]);
        }
    }
    if (free_part_) {
        to.theta = step.along * from.theta + step.moved * from.velocity;
        to.velocity = step.kept * from.velocity - free_.w0_squared() * step.moved * from.theta;
    }
    next_place_ = place_ + lengths_[i];
    return there_ = sum(to, next_place_);
}

double WalkedCurve::fourth_bound(double until) const {
    double bound = sines_fourth_;
    if (free_part_) bound += free_.fourth_bound(now().theta, now().velocity);
    for (std::size_t j = 0; j < rate_.size(); ++j) {
        const double square = rate_[j] * rate_[j];
        bound += std::fabs(now().amount[j]) * square * square * std::exp(std::max(0.0, rate_[j] * (until - place_)));
    }
    if (powers_.size() > 4) {
        double sum = 0;
        for (std::size_t i = powers_.size(); i-- > 4;) {
            const auto n = static_cast<double>(i);
            sum = sum * until + std::fabs(powers_[i]) * (n * (n - 1) * (n - 2) * (n - 3));
        }
        bound += sum;
    }
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Resonance& r = resonances_[j];
        const double g = std::abs(now().difference[j]) + (until - place_);  // |g'| <= 1 less a decay
        bound += r.fourth_growing * g + r.fourth_turning;
    }
    return bound;
}

double WalkedCurve::size(double until) const {
    double sum = 0;
    for (std::size_t n = powers_.size(); n-- > 0;) sum = sum * until + std::fabs(powers_[n]);
    sum += sines_size_;
    for (const double a : now().amount) sum += std::fabs(a);
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        sum += std::abs(resonances_[j].growing) * std::abs(now().difference[j]) + std::abs(resonances_[j].turning);
    }
    if (free_part_) sum += std::fabs(now().velocity) + free_.w0() * std::fabs(now().theta);
    return sum;
}

}  // namespace dinal::motion::exact
