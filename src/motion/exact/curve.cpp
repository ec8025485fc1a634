#include "motion/exact/curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal::motion::exact {

namespace {

/// The longest tabulated look, in natural periods; each level halves it.
constexpr double longest_look = 8;

/// 1/n and 1/n!
constexpr std::array<double, 8> over{0, 1, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7};
constexpr std::array<double, 7> over_factorial{1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720};
static_assert(over.size() == WalkedCurve::jet_order + 2 && over_factorial.size() == WalkedCurve::jet_order + 1);

}  // namespace

WalkedCurve::WalkedCurve(const LinearMotion& free)
    : free_(free), longest_(longest_look * 2 * std::numbers::pi / free.w0()), fastest_(free.fastest()) {
    slots_.fill(none);
    kept_.fill(none);
}

bool WalkedCurve::same_resonances() const {
    return std::equal(resonances_.begin(), resonances_.end(), table_mu_.begin(), table_mu_.end(),
                      [](const Resonance& a, Complex mu) { return a.mu == mu; });
}

/// Clears the tables after a change of frequencies or rates.
void WalkedCurve::make_table() {
    changed_ = false;
    omega_.resize(sines_), rate_.resize(rates_);
    table_mu_.clear();
    for (const Resonance& resonance : resonances_) table_mu_.push_back(resonance.mu);
    slots_.fill(none);
    kept_.fill(none);
    turns_.clear(), sine_rows_.clear(), growth_rows_.clear(), resonance_rows_.clear();
    for (Moment* moment : {&start_, &first_, &second_, &other_}) {
        moment->sines.resize(sines_);
        moment->amounts.resize(rates_);
        moment->resonances.resize(resonances_.size());
    }
    std::fill(start_.resonances.begin(), start_.resonances.end(), std::array<Complex, 2>{0, 1});
    fastest_ = free_.fastest();
    for (const double omega : omega_) fastest_ = std::max(fastest_, std::fabs(omega));
    for (const double rate : rate_) fastest_ = std::max(fastest_, std::fabs(rate));
    for (const Complex mu : table_mu_) fastest_ = std::max(fastest_, std::fabs(mu.imag()));
}

void WalkedCurve::begin() {
    if (free_part_ && !turns_free_) turns_free_ = changed_ = true;
    if (changed_ || sines_ != omega_.size() || rates_ != rate_.size() || !same_resonances()) make_table();
    only_swings_ = powers_.empty() && rates_ == 0 && resonances_.empty();
    now_ = &start_, next_ = &first_;
    place_ = 0;
    Value y{};
    double size = 0, fourth = 0;
    for (std::size_t j = 0; j < sines_; ++j) {
        const Complex z = start_.sines[j];
        const double omega = omega_[j], square = omega * omega, length = length_of(z);
        size += length;
        fourth += length * (square * square);
        y.f += z.imag(), y.slope += omega * z.real();
    }
    sines_size_ = size, sines_fourth_ = fourth;
    if (free_part_) {
        y.f += free_.velocity(start_.free);
        y.slope += free_.acceleration(start_.free);
    }
    if (!only_swings_) {
        const Value more = powers(0);
        y.f += more.f, y.slope += more.slope;
        for (std::size_t j = 0; j < rates_; ++j) {
            y.f += start_.amounts[j], y.slope += rate_[j] * start_.amounts[j];
        }
        for (const Resonance& r : resonances_) y.f += r.turning.imag(), y.slope += r.slope_turning.imag();
    }
    here_ = y;
}

WalkedCurve::Value WalkedCurve::powers(double tau) const {
    Value y;
    for (std::size_t n = powers_.size(); n-- > 0;) {
        y.slope = y.slope * tau + y.f;
        y.f = y.f * tau + powers_[n];
    }
    return y;
}

std::uint8_t WalkedCurve::new_turn(double tau) {
    constexpr std::size_t few = 8;
    if (turns_.empty()) turns_.reserve(few), sine_rows_.reserve(few * sines_);
    const std::size_t row = turns_.size();
    turns_.emplace_back().row = row;
    sine_rows_.resize((row + 1) * sines_);
    if (rates_ > 0) growth_rows_.resize((row + 1) * rates_);
    if (!resonances_.empty()) resonance_rows_.resize((row + 1) * resonances_.size());
    make_turn(tau, turns_.back());
    return static_cast<std::uint8_t>(row);
}

void WalkedCurve::make_turn(double tau, Turn& to) {
    to.tau = tau;
    Complex* factor = sine_rows_.data() + to.row * sines_;
    for (std::size_t j = 0; j < sines_; ++j) {
        const double x = omega_[j] * tau, small = std::fma(omega_[j], tau, -x), s = std::sin(x), c = std::cos(x);
        factor[j] = {c - small * s, s + small * c};
    }
    double* growth = growth_rows_.data() + to.row * rates_;
    for (std::size_t j = 0; j < rates_; ++j) growth[j] = std::exp(rate_[j] * tau);
    FreeStep step{};
    if (!resonances_.empty()) {
        to.root = free_.turned(tau);
        std::array<Complex, 2>* turned = resonance_rows_.data() + to.row * resonances_.size();
        for (std::size_t j = 0; j < resonances_.size(); ++j) {
            const Complex difference = resonances_[j].difference(tau, to.root);
            turned[j] = {difference, to.root + times(resonances_[j].from_root, difference)};
        }
        step = free_.step(to.root);
    } else if (turns_free_) {
        step = free_.parts_after(tau);
    }
    to.along = step.along, to.moved = step.moved, to.kept = step.kept;
    to.bent = free_.w0_squared() * step.moved;
}

/// Turns the rarer parts: powers, exponentials and resonances.
void WalkedCurve::turn_others(const Moment& from, const Turn& by, Moment& to, double place, Value& y) const {
    const Value sum = powers(place);
    y.f += sum.f, y.slope += sum.slope;
    const double* growth = growth_rows_.data() + by.row * rates_;
    const std::array<Complex, 2>* resonance = resonance_rows_.data() + by.row * resonances_.size();
    for (std::size_t j = 0; j < rates_; ++j) {
        const double amount = from.amounts[j] * growth[j];
        to.amounts[j] = amount;
        y.f += amount;
        y.slope += rate_[j] * amount;
    }
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const auto& [g, u] = from.resonances[j];
        const auto& [difference, turned] = resonance[j];
        const Complex to_g = times(by.root, g) + times(u, difference), to_u = times(u, turned);
        to.resonances[j] = {to_g, to_u};
        const Resonance& part = resonances_[j];
        y.f += imaginary(part.growing, to_g, part.turning, to_u);
        y.slope += imaginary(part.slope_growing, to_g, part.slope_turning, to_u);
    }
}

const WalkedCurve::Jet& WalkedCurve::derive(const Value& y) {
    const Moment& asked = *asked_;
    double second = 0, third = 0;
    for (std::size_t j = 0; j < sines_; ++j) {
        const Complex z = asked.sines[j];
        const double omega = omega_[j], square = omega * omega;
        second -= square * z.imag();
        third -= square * (omega * z.real());
    }
    if (free_part_) {
        const FreeParts bend = free_.derivative(free_.derivative(asked.free));
        second += free_.velocity(bend);
        third += free_.acceleration(bend);
    }
    jet_[0] = y.f, jet_[1] = y.slope, jet_[2] = second / 2, jet_[3] = third * over_factorial[3];
    jet_size_ = 4;
    if (!only_swings_) derive_others(2, 3);
    return jet_;
}

const WalkedCurve::Jet& WalkedCurve::further_jet() {
    const Moment& asked = *asked_;
    constexpr std::size_t first = 4;
    for (std::size_t i = first; i <= jet_order; ++i) jet_[i] = 0;
    for (std::size_t j = 0; j < sines_; ++j) {
        const Complex z = asked.sines[j];
        const double square = omega_[j] * omega_[j], fourth = square * square;
        jet_[4] += fourth * z.imag();
        jet_[5] += fourth * (omega_[j] * z.real());
        jet_[6] -= fourth * (square * z.imag());
    }
    if (free_part_) {
        FreeParts y = asked.free;
        for (std::size_t i = 1; i <= jet_order; ++i) {
            y = free_.derivative(y);
            if (i >= first) jet_[i] += free_.velocity(y);
        }
    }
    for (std::size_t i = first; i <= jet_order; ++i) jet_[i] *= over_factorial[i];
    jet_size_ = jet_order + 1;
    if (!only_swings_) derive_others(first, jet_order);
    return jet_;
}

/// The derivatives of the rarer parts, from one order to another.
void WalkedCurve::derive_others(std::size_t from, std::size_t to) {
    const Moment& asked = *asked_;
    Jet more{};
    for (std::size_t j = 0; j < rates_; ++j) {
        double f = rate_[j] * asked.amounts[j];
        for (std::size_t i = 2; i <= to; ++i) more[i] += f *= rate_[j];
    }
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Resonance& r = resonances_[j];
        const auto& [g, u] = asked.resonances[j];
        const Complex root = free_.root();
        const double omega = r.mu.imag();
        Complex growing = times(r.slope_growing, g), turned = times(r.slope_growing, u);
        Complex turning = times(r.slope_turning, u);
        for (std::size_t i = 2; i <= to; ++i) {
            // g' = root g + exp(mu tau)
            growing = times(growing, root);
            turning = {turned.real() - omega * turning.imag(), turned.imag() + omega * turning.real()};
            turned = times(turned, root);
            more[i] += growing.imag() + turning.imag();
        }
    }
    for (std::size_t i = from; i <= to; ++i) jet_[i] += more[i] * over_factorial[i];
    if (powers_.size() <= from) return;
    Jet about{};
    for (std::size_t n = powers_.size(); n-- > 0;) {
        for (std::size_t i = to; i > 0; --i) about[i] = about[i] * asked_place_ + about[i - 1];
        about[0] = about[0] * asked_place_ + powers_[n];
    }
    for (std::size_t i = from; i <= to; ++i) jet_[i] += about[i];
}

double WalkedCurve::way() const {
    const Moment& asked = *asked_;
    double sum = 0;
    for (std::size_t i = way_powers_.size(); i-- > 0;) sum = sum * asked_place_ + way_powers_[i];
    for (std::size_t j = 0; j < sines_; ++j) sum -= asked.sines[j].real() / omega_[j];
    for (std::size_t j = 0; j < rates_; ++j) sum += asked.amounts[j] / rate_[j];
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Resonance& r = resonances_[j];
        sum += imaginary(r.way_growing, asked.resonances[j][0], r.way_turning, asked.resonances[j][1]);
    }
    if (free_part_) sum += free_.theta(asked.free);
    if (aside_ == 0) return sum;
    double further = 0;
    for (std::size_t i = jet_size_; i-- > 4;) further = (further + jet_[i] * over[i + 1]) * aside_;
    for (std::size_t i = 4; i-- > 0;) further = (further + jet_[i] * over[i + 1]) * aside_;
    return sum + further;
}

/// The bound for the rarer parts.
double WalkedCurve::growing_bound(double until) const {
    double bound = 0;
    for (std::size_t j = 0; j < rates_; ++j) {
        const double square = rate_[j] * rate_[j];
        bound += std::fabs(now_->amounts[j]) * square * square * std::exp(std::max(0.0, rate_[j] * (until - place_)));
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
        const double g = length_of(now_->resonances[j][0]) + (until - place_);  // |g'| <= 1 minus a decay
        bound += r.fourth_growing * g + r.fourth_turning;
    }
    return bound;
}

double WalkedCurve::size(double until) const {
    double sum = sines_size_;
    if (free_part_) sum += free_.size(now_->free);
    if (only_swings_) return sum;
    double of_powers = 0;
    for (std::size_t n = powers_.size(); n-- > 0;) of_powers = of_powers * until + std::fabs(powers_[n]);
    for (std::size_t j = 0; j < rates_; ++j) sum += std::fabs(now_->amounts[j]);
    for (std::size_t j = 0; j < resonances_.size(); ++j) {
        const Complex& g = now_->resonances[j][0];
        sum += length_of(resonances_[j].growing) * length_of(g) + length_of(resonances_[j].turning);
    }
    return sum + of_powers;
}

}  // namespace dinal::motion::exact
