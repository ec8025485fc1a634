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

/// Only hears whether there is more than a constant.
struct Listener {
    bool more = false;
    void add_constant(double /*level*/) {}
    void add_line(double /*at*/, double /*level*/, double slope) { more = more || slope != 0; }
    void add_powers(double /*at*/, std::span<const double> coefficients) { more = more || coefficients.size() > 1; }
    void add_sine(double /*amplitude*/, double /*omega*/, double /*at*/, double /*phase*/) { more = true; }
    void add_exponential(double /*amplitude*/, double /*rate*/, double /*at*/) { more = true; }
};

/// Polynomials of so many coefficients are shifted without asking for memory.
constexpr std::size_t max_powers = 16;

}  // namespace

void ClosedForm::add_powers(double at, std::span<const double> coefficients) {
    if (coefficients.empty()) return;
    const std::size_t n = coefficients.size();
    reach(n - 1);
    const double shift = since(at);
    // Horner's scheme with a remainder kept at each step: the coefficients about the origin, the constant one first.
    std::array<double, max_powers> carried{};
    std::vector<double> many;
    double* c = carried.data();
    if (n > max_powers) {
        many.assign(n, 0.0);
        c = many.data();
    }
    std::copy(coefficients.begin(), coefficients.end(), c);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = n - 1; j > i; --j) c[j - 1] += shift * c[j];
        powers_[i] += gain_ * c[i];
    }
}

/// The phase at the origin is a sum in two doubles: far from `at` its rounding would be that of the time.
void ClosedForm::add_sine(double amplitude, double omega, double at, double phase) {
    const double far = time_ - at;
    const double back = time_ - far;
    const double rest = ((time_ - (far + back)) + (back - at)) + rest_;
    const double turned = omega * far;
    const double turned_rest = std::fma(omega, far, -turned) + omega * rest;
    const double angle = turned + phase;
    const double part = angle - turned;
    const double small = ((turned - (angle - part)) + (phase - part)) + turned_rest;
    const double s = std::sin(angle), c = std::cos(angle), a = gain_ * amplitude;
    if (omega == 0) {
        powers_[0] += a * (s + small * c);
        return;
    }
    omega_.push_back(omega);
    in_phase_.push_back(a * (c - small * s));
    quadrature_.push_back(a * (s + small * c));
}

void ClosedForm::add_exponential(double amplitude, double rate, double at) {
    const double amount = terms::Exponential::grown(gain_ * amplitude, rate * since(at));
    if (amount == 0) return;  // what has decayed to nothing must not keep the arcs short
    rate_.push_back(rate);
    amount_.push_back(amount);
}

double ClosedForm::value() const {
    double sum = powers_[0];
    for (const double q : quadrature_) sum += q;
    for (const double a : amount_) sum += a;
    return sum;
}

double ClosedForm::value(double tau) const {
    double sum = 0;
    for (std::size_t n = powers_.size(); n-- > 0;) sum = sum * tau + powers_[n];
    for (std::size_t j = 0; j < omega_.size(); ++j) {
        sum += in_phase_[j] * std::sin(omega_[j] * tau) + quadrature_[j] * std::cos(omega_[j] * tau);
    }
    for (std::size_t j = 0; j < rate_.size(); ++j) sum += amount_[j] * std::exp(rate_[j] * tau);
    return sum;
}

double ClosedForm::slope() const {
    double sum = powers_.size() > 1 ? powers_[1] : 0;
    for (std::size_t j = 0; j < omega_.size(); ++j) sum += omega_[j] * in_phase_[j];
    for (std::size_t j = 0; j < rate_.size(); ++j) sum += rate_[j] * amount_[j];
    return sum;
}

double ClosedForm::bend() const {
    double sum = powers_.size() > 2 ? 2 * powers_[2] : 0;
    for (std::size_t j = 0; j < omega_.size(); ++j) sum -= omega_[j] * omega_[j] * quadrature_[j];
    for (std::size_t j = 0; j < rate_.size(); ++j) sum += rate_[j] * rate_[j] * amount_[j];
    return sum;
}

double ClosedForm::fastest() const {
    double most = 0;
    for (const double omega : omega_) most = std::max(most, std::fabs(omega));
    for (const double r : rate_) most = std::max(most, std::fabs(r));
    return most;
}

double ClosedForm::grows_in() const {
    double most = 0;
    for (const double r : rate_) most = std::max(most, r);
    return most > 0 ? 1 / most : never;
}

bool has_closed_form(const Excitation& excitation) {
    const auto components = excitation.components();
    return std::all_of(components.begin(), components.end(), [](const Component& c) {
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

bool stays_as_it_is(const Component& component, double inside) {
    if (component.gain == 0 || inside < component.from || inside >= component.to) return true;
    return std::visit(
        [inside](const auto& term) {
            Listener heard;
            if constexpr (requires { term.closed_form(inside, heard); }) {
                term.closed_form(inside, heard);
                return !heard.more;
            } else {
                return false;
            }
        },
        component.term);
}

}  // namespace dinal::model
