// M on a smooth stretch as a formula: powers, sines and exponentials of the time since a moment in that stretch.
//
// Each native term that has one says it in its own file: `closed_form(inside, sum)` adds to `sum` what the term is on
// the stretch between its breaks in which the time `inside` lies. A term without that question has no closed form.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/excitation.hpp"

namespace dinal::model {

/// A sum of c_n tau^n, of p sin(omega tau) + q cos(omega tau) and of a exp(rate tau), for a time tau counted from its
/// origin, which is a double and what that lacks.
class ClosedForm {
public:
    /// Nothing yet, counted from `time` + `rest`.
    void begin(double time, double rest) {
        time_ = time, rest_ = rest;
        powers_.assign(1, 0.0);
        omega_.clear(), in_phase_.clear(), quadrature_.clear();
        rate_.clear(), amount_.clear();
    }
    /// What terms say is this many times as much, from here on.
    void set_gain(double gain) { gain_ = gain; }

    // What a term says.
    void add_constant(double level) { powers_[0] += gain_ * level; }
    /// `level` at the time `at`, and from there a straight line.
    void add_line(double at, double level, double slope) {
        reach(1);
        powers_[0] += gain_ * (level + slope * since(at));
        powers_[1] += gain_ * slope;
    }
    /// coefficients[n] (t - at)^n
    void add_powers(double at, std::span<const double> coefficients);
    /// amplitude sin(omega (t - at) + phase)
    void add_sine(double amplitude, double omega, double at, double phase);
    /// amplitude exp(rate (t - at))
    void add_exponential(double amplitude, double rate, double at);

    // The sum.
    [[nodiscard]] std::span<const double> powers() const { return powers_; }
    [[nodiscard]] std::span<const double> omega() const { return omega_; }
    [[nodiscard]] std::span<const double> in_phase() const { return in_phase_; }      ///< of sin(omega tau)
    [[nodiscard]] std::span<const double> quadrature() const { return quadrature_; }  ///< of cos(omega tau)
    [[nodiscard]] std::span<const double> rate() const { return rate_; }
    [[nodiscard]] std::span<const double> amount() const { return amount_; }

    /// At the origin.
    [[nodiscard]] double value() const;
    [[nodiscard]] double value(double tau) const;
    /// The first and the second derivative at the origin.
    [[nodiscard]] double slope() const;
    [[nodiscard]] double bend() const;
    /// The greatest of its frequencies and rates (per time unit), 0 for a polynomial.
    [[nodiscard]] double fastest() const;
    /// How long its fastest growing part takes to grow by e; `never` without one.
    [[nodiscard]] double grows_in() const;

private:
    [[nodiscard]] double since(double at) const { return (time_ - at) + rest_; }
    void reach(std::size_t power) {
        if (powers_.size() <= power) powers_.resize(power + 1, 0.0);
    }

    double time_ = 0, rest_ = 0, gain_ = 1;
    std::vector<double> powers_ = {0.0};
    std::vector<double> omega_, in_phase_, quadrature_;
    std::vector<double> rate_, amount_;
};

/// Whether M has a closed form on each of its smooth stretches.
bool has_closed_form(const Excitation& excitation);

/// The closed form from `time` on, up to the next break after it, counted from `time` + `rest`. Only for an excitation
/// that has one.
void closed_form(const Excitation& excitation, double time, double rest, ClosedForm& sum);

/// Whether a native component is constant on the stretch between its breaks in which this time lies.
bool stays_as_it_is(const Component& component, double inside);

}  // namespace dinal::model
