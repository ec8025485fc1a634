#include "model/closed_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace dinal::model {

namespace {

template <class T>
concept WithClosedForm = requires(const T& term, double inside, ClosedForm& sum) {
    term.closed_form(inside, sum);
};

/// The most coefficients that are shifted without allocation.
constexpr std::size_t max_powers = 16;

}  // namespace

void ClosedForm::add_powers(double at, std::span<const double> coefficients) {
    const std::size_t n = coefficients.size();
    reach(n - 1);
    const double shift = since(at);
    // Horner's scheme with a remainder kept at each step yields the coefficients about the origin, the constant one
    // first.
    std::array<double, max_powers> carried{};
    std::vector<double> many;
    double* c = carried.data();
    if (n > max_powers) {
        many.assign(n, 0.0);
        c = many.data();
    }
    std::ranges::copy(coefficients, c);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = n - 1; j > i; --j) c[j - 1] += shift * c[j];
        powers_[i] += gain_ * c[i];
    }
}

/// The phase at the origin is summed in two doubles: far from `at`, one double would add an error as large as that of
/// the time.
void ClosedForm::add_sine(double amplitude, double omega, double at, double phase) {
    const auto [angle, small] = terms::angle_at(time_, rest_, omega, at, phase);
    const double s = std::sin(angle), c = std::cos(angle), a = gain_ * amplitude;
    if (omega == 0) {
        powers_[0] += a * (s + small * c);
        return;
    }
    sines_.push_back({omega, a * (c - small * s), a * (s + small * c)});
    fastest_ = std::max(fastest_, std::fabs(omega));
}

void ClosedForm::add_exponential(double amplitude, double rate, double at) {
    const double amount = terms::Exponential::grown(gain_ * amplitude, rate * since(at));
    if (amount == 0) return;  // a decayed part must not keep the arcs short
    exponentials_.push_back({rate, amount});
    fastest_ = std::max(fastest_, std::fabs(rate));
    growth_ = std::max(growth_, rate);
}

double ClosedForm::value() const {
    double sum = powers_[0];
    for (const Sine& sine : sines_) sum += sine.quadrature;
    for (const Exponential& e : exponentials_) sum += e.amount;
    return sum;
}

double ClosedForm::value(double tau) const {
    double sum = 0;
    for (std::size_t n = powers_.size(); n-- > 0;) sum = sum * tau + powers_[n];
    for (const auto& [omega, in_phase, quadrature] : sines_) {
        sum += in_phase * std::sin(omega * tau) + quadrature * std::cos(omega * tau);
    }
    for (const auto& [rate, amount] : exponentials_) sum += amount * std::exp(rate * tau);
    return sum;
}

double ClosedForm::slope() const {
    double sum = powers_.size() > 1 ? powers_[1] : 0;
    for (const Sine& sine : sines_) sum += sine.omega * sine.in_phase;
    for (const auto& [rate, amount] : exponentials_) sum += rate * amount;
    return sum;
}

double ClosedForm::bend() const {
    double sum = powers_.size() > 2 ? 2 * powers_[2] : 0;
    for (const Sine& sine : sines_) sum -= sine.omega * sine.omega * sine.quadrature;
    for (const auto& [rate, amount] : exponentials_) sum += rate * rate * amount;
    return sum;
}

bool has_closed_form(const Excitation& excitation) {
    const auto components = excitation.components();
    return std::ranges::all_of(components, [](const Component& c) {
        return std::visit([](const auto& term) { return WithClosedForm<std::decay_t<decltype(term)>>; }, c.term);
    });
}

void closed_form(const Excitation& excitation, double time, double rest, ClosedForm& sum) {
    sum.begin(time, rest);
    for (const Component& c : excitation.components()) {
        if (c.gain == 0 || time < c.from || time >= c.to) continue;
        sum.set_gain(c.gain);
        std::visit(
            [time, &sum](const auto& term) {
                if constexpr (WithClosedForm<std::decay_t<decltype(term)>>) term.closed_form(time, sum);
            },
            c.term);
    }
}

}  // namespace dinal::model
