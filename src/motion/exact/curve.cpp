#include "motion/exact/curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal::motion::exact {

namespace {

/// The longest tabulated step ("look"), in natural periods; each level halves it.
constexpr double longest_look = 8;

/// 1/n and 1/n!
constexpr std::array<double, 8> over{0, 1, 1.0 / 2, 1.0 / 3, 1.0 / 4, 1.0 / 5, 1.0 / 6, 1.0 / 7};
constexpr std::array<double, 7> over_factorial{1, 1, 1.0 / 2, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720};
static_assert(over.size() == WalkedCurve::jet_order + 2 && over_factorial.size() == WalkedCurve::jet_order + 1);

}  // namespace

WalkedCurve::WalkedCurve(const LinearMotion& free)
    : free_(free), fastest_(free.fastest()), table_(longest_look * 2 * std::numbers::pi / free.w0()) {}

bool WalkedCurve::same_resonances() const {
    return std::equal(sum_.resonances.begin(), sum_.resonances.end(), table_.mu.begin(), table_.mu.end(),
                      [](const Resonance& a, Complex mu) { return a.mu == mu; });
}

/// Clears the tables after a change of frequencies or rates.
void WalkedCurve::make_table() {
    sum_.changed = false;
    sum_.omega.resize(sum_.sines), sum_.rate.resize(sum_.rates);
    table_.clear();
    for (const Resonance& resonance : sum_.resonances) table_.mu.push_back(resonance.mu);
    for (PartValues* values : {&start_, &first_, &second_, &other_}) {
        values->sines.resize(sum_.sines);
        values->amounts.resize(sum_.rates);
        values->resonances.resize(sum_.resonances.size());
    }
    std::fill(start_.resonances.begin(), start_.resonances.end(), std::array<Complex, 2>{0, 1});
    fastest_ = free_.fastest();
    for (const double omega : sum_.omega) fastest_ = std::max(fastest_, std::fabs(omega));
    for (const double rate : sum_.rate) fastest_ = std::max(fastest_, std::fabs(rate));
    for (const Complex mu : table_.mu) fastest_ = std::max(fastest_, std::fabs(mu.imag()));
}

void WalkedCurve::begin() {
    if (sum_.has_free && !table_.has_free) table_.has_free = sum_.changed = true;
    if (sum_.changed || sum_.sines != sum_.omega.size() || sum_.rates != sum_.rate.size() || !same_resonances())
        make_table();
    only_swings_ = sum_.powers.empty() && sum_.rates == 0 && sum_.resonances.empty();
    now_ = &start_, next_ = &first_;
    place_ = 0;
    Value y{};
    double size = 0, fourth = 0;
    for (std::size_t j = 0; j < sum_.sines; ++j) {
        const Complex z = start_.sines[j];
        const double omega = sum_.omega[j], square = omega * omega, length = length_of(z);
        size += length;
        fourth += length * (square * square);
        y.f += z.imag(), y.slope += omega * z.real();
    }
    sines_size_ = size, sines_fourth_ = fourth;
    if (sum_.has_free) {
        y.f += free_.velocity(start_.free);
        y.slope += free_.acceleration(start_.free);
    }
    if (!only_swings_) {
        const Value more = powers(0);
        y.f += more.f, y.slope += more.slope;
        for (std::size_t j = 0; j < sum_.rates; ++j) {
            y.f += start_.amounts[j], y.slope += sum_.rate[j] * start_.amounts[j];
        }
        for (const Resonance& r : sum_.resonances) y.f += r.turning.imag(), y.slope += r.slope_turning.imag();
    }
    here_ = y;
}

WalkedCurve::Value WalkedCurve::powers(double tau) const {
    Value y;
    for (std::size_t n = sum_.powers.size(); n-- > 0;) {
        y.slope = y.slope * tau + y.f;
        y.f = y.f * tau + sum_.powers[n];
    }
    return y;
}

std::uint8_t WalkedCurve::new_turn(double tau) {
    constexpr std::size_t few = 8;
    if (table_.turns.empty()) table_.turns.reserve(few), table_.sine_rows.reserve(few * sum_.sines);
    const std::size_t row = table_.turns.size();
    table_.turns.emplace_back().row = row;
    table_.sine_rows.resize((row + 1) * sum_.sines);
    if (sum_.rates > 0) table_.growth_rows.resize((row + 1) * sum_.rates);
    if (!sum_.resonances.empty()) table_.resonance_rows.resize((row + 1) * sum_.resonances.size());
    make_turn(tau, table_.turns.back());
    return static_cast<std::uint8_t>(row);
}

void WalkedCurve::make_turn(double tau, Turn& to) {
    to.tau = tau;
    Complex* factor = table_.sine_rows.data() + to.row * sum_.sines;
    for (std::size_t j = 0; j < sum_.sines; ++j) {
        const double x = sum_.omega[j] * tau, small = std::fma(sum_.omega[j], tau, -x), s = std::sin(x),
                     c = std::cos(x);
        factor[j] = {c - small * s, s + small * c};
    }
    double* growth = table_.growth_rows.data() + to.row * sum_.rates;
    for (std::size_t j = 0; j < sum_.rates; ++j) growth[j] = std::exp(sum_.rate[j] * tau);
    FreeStep step{};
    if (!sum_.resonances.empty()) {
        to.root = free_.turned(tau);
        std::array<Complex, 2>* turned = table_.resonance_rows.data() + to.row * sum_.resonances.size();
        for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
            const Complex difference = sum_.resonances[j].difference(tau, to.root);
            turned[j] = {difference, to.root + product(sum_.resonances[j].from_root, difference)};
        }
        step = free_.step(to.root);
    } else if (table_.has_free) {
        step = free_.parts_after(tau);
    }
    to.along = step.along, to.moved = step.moved, to.kept = step.kept;
    to.bent = free_.w0_squared() * step.moved;
}

/// Advances the rarer parts: powers, exponentials and resonances.
void WalkedCurve::turn_others(const PartValues& from, const Turn& by, PartValues& to, double place, Value& y) const {
    const Value sum = powers(place);
    y.f += sum.f, y.slope += sum.slope;
    const double* growth = table_.growth_rows.data() + by.row * sum_.rates;
    const std::array<Complex, 2>* resonance = table_.resonance_rows.data() + by.row * sum_.resonances.size();
    for (std::size_t j = 0; j < sum_.rates; ++j) {
        const double amount = from.amounts[j] * growth[j];
        to.amounts[j] = amount;
        y.f += amount;
        y.slope += sum_.rate[j] * amount;
    }
    for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
        const auto& [g, u] = from.resonances[j];
        const auto& [difference, turned] = resonance[j];
        const Complex to_g = product(by.root, g) + product(u, difference), to_u = product(u, turned);
        to.resonances[j] = {to_g, to_u};
        const Resonance& part = sum_.resonances[j];
        y.f += imaginary(part.growing, to_g, part.turning, to_u);
        y.slope += imaginary(part.slope_growing, to_g, part.slope_turning, to_u);
    }
}

const WalkedCurve::Jet& WalkedCurve::derive(const Value& y) {
    const PartValues& point = *last_point_.values;
    double second = 0, third = 0;
    for (std::size_t j = 0; j < sum_.sines; ++j) {
        const Complex z = point.sines[j];
        const double omega = sum_.omega[j], square = omega * omega;
        second -= square * z.imag();
        third -= square * (omega * z.real());
    }
    if (sum_.has_free) {
        const FreeParts bend = free_.derivative(free_.derivative(point.free));
        second += free_.velocity(bend);
        third += free_.acceleration(bend);
    }
    last_point_.jet[0] = y.f, last_point_.jet[1] = y.slope, last_point_.jet[2] = second / 2,
    last_point_.jet[3] = third * over_factorial[3];
    last_point_.jet_size = 4;
    if (!only_swings_) derive_others(2, 3);
    return last_point_.jet;
}

const WalkedCurve::Jet& WalkedCurve::further_jet() {
    const PartValues& point = *last_point_.values;
    constexpr std::size_t first = 4;
    for (std::size_t i = first; i <= jet_order; ++i) last_point_.jet[i] = 0;
    for (std::size_t j = 0; j < sum_.sines; ++j) {
        const Complex z = point.sines[j];
        const double square = sum_.omega[j] * sum_.omega[j], fourth = square * square;
        last_point_.jet[4] += fourth * z.imag();
        last_point_.jet[5] += fourth * (sum_.omega[j] * z.real());
        last_point_.jet[6] -= fourth * (square * z.imag());
    }
    if (sum_.has_free) {
        FreeParts y = point.free;
        for (std::size_t i = 1; i <= jet_order; ++i) {
            y = free_.derivative(y);
            if (i >= first) last_point_.jet[i] += free_.velocity(y);
        }
    }
    for (std::size_t i = first; i <= jet_order; ++i) last_point_.jet[i] *= over_factorial[i];
    last_point_.jet_size = jet_order + 1;
    if (!only_swings_) derive_others(first, jet_order);
    return last_point_.jet;
}

/// Computes the derivatives, from order `from` to `to`, of all parts except sines and the free motion.
void WalkedCurve::derive_others(std::size_t from, std::size_t to) {
    const PartValues& point = *last_point_.values;
    Jet more{};
    for (std::size_t j = 0; j < sum_.rates; ++j) {
        double f = sum_.rate[j] * point.amounts[j];
        for (std::size_t i = 2; i <= to; ++i) more[i] += f *= sum_.rate[j];
    }
    for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
        const Resonance& r = sum_.resonances[j];
        const auto& [g, u] = point.resonances[j];
        const Complex root = free_.root();
        const double omega = r.mu.imag();
        Complex growing = product(r.slope_growing, g), turned = product(r.slope_growing, u);
        Complex turning = product(r.slope_turning, u);
        for (std::size_t i = 2; i <= to; ++i) {
            // g' = root g + exp(mu tau)
            growing = product(growing, root);
            turning = {turned.real() - omega * turning.imag(), turned.imag() + omega * turning.real()};
            turned = product(turned, root);
            more[i] += growing.imag() + turning.imag();
        }
    }
    for (std::size_t i = from; i <= to; ++i) last_point_.jet[i] += more[i] * over_factorial[i];
    if (sum_.powers.size() <= from) return;
    Jet about{};
    for (std::size_t n = sum_.powers.size(); n-- > 0;) {
        for (std::size_t i = to; i > 0; --i) about[i] = about[i] * last_point_.place + about[i - 1];
        about[0] = about[0] * last_point_.place + sum_.powers[n];
    }
    for (std::size_t i = from; i <= to; ++i) last_point_.jet[i] += about[i];
}

double WalkedCurve::way() const {
    const PartValues& point = *last_point_.values;
    double sum = 0;
    for (std::size_t i = sum_.way_powers.size(); i-- > 0;) sum = sum * last_point_.place + sum_.way_powers[i];
    for (std::size_t j = 0; j < sum_.sines; ++j) sum -= point.sines[j].real() / sum_.omega[j];
    for (std::size_t j = 0; j < sum_.rates; ++j) sum += point.amounts[j] / sum_.rate[j];
    for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
        const Resonance& r = sum_.resonances[j];
        sum += imaginary(r.way_growing, point.resonances[j][0], r.way_turning, point.resonances[j][1]);
    }
    if (sum_.has_free) sum += free_.theta(point.free);
    return last_point_.aside == 0 ? sum : sum + last_point_.further_way();
}

double WalkedCurve::LastPoint::further_way() const {
    double further = 0;
    for (std::size_t i = jet_size; i-- > 4;) further = (further + jet[i] * over[i + 1]) * aside;
    for (std::size_t i = 4; i-- > 0;) further = (further + jet[i] * over[i + 1]) * aside;
    return further;
}

/// The part of the bound due to the rarer parts.
double WalkedCurve::growing_bound(double until) const {
    double bound = 0;
    for (std::size_t j = 0; j < sum_.rates; ++j) {
        const double square = sum_.rate[j] * sum_.rate[j];
        bound +=
            std::fabs(now_->amounts[j]) * square * square * std::exp(std::max(0.0, sum_.rate[j] * (until - place_)));
    }
    if (sum_.powers.size() > 4) {
        double sum = 0;
        for (std::size_t i = sum_.powers.size(); i-- > 4;) {
            const auto n = static_cast<double>(i);
            sum = sum * until + std::fabs(sum_.powers[i]) * (n * (n - 1) * (n - 2) * (n - 3));
        }
        bound += sum;
    }
    for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
        const Resonance& r = sum_.resonances[j];
        const double g = length_of(now_->resonances[j][0]) + (until - place_);  // |g'| <= 1 minus a decay
        bound += r.fourth_growing * g + r.fourth_turning;
    }
    return bound;
}

double WalkedCurve::size(double until) const {
    double sum = sines_size_;
    if (sum_.has_free) sum += free_.size(now_->free);
    if (only_swings_) return sum;
    double of_powers = 0;
    for (std::size_t n = sum_.powers.size(); n-- > 0;) of_powers = of_powers * until + std::fabs(sum_.powers[n]);
    for (std::size_t j = 0; j < sum_.rates; ++j) sum += std::fabs(now_->amounts[j]);
    for (std::size_t j = 0; j < sum_.resonances.size(); ++j) {
        const Complex& g = now_->resonances[j][0];
        sum += length_of(sum_.resonances[j].growing) * length_of(g) + length_of(sum_.resonances[j].turning);
    }
    return sum + of_powers;
}

}  // namespace dinal::motion::exact
