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
        powers_.resize(1);
        powers_[0] = 0;
        sines_.clear(), exponentials_.clear();
        fastest_ = growth_ = 0;
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
    struct Sine {
        double omega;
        double in_phase, quadrature;  ///< of sin(omega tau) and cos(omega tau)
    };
    [[nodiscard]] std::span<const Sine> sines() const { return sines_; }
    struct Exponential {
        double rate, amount;
    };
    [[nodiscard]] std::span<const Exponential> exponentials() const { return exponentials_; }
    /// Of those and these.
    [[nodiscard]] std::size_t turning_parts() const { return sines_.size() + exponentials_.size(); }

    /// At the origin.
    [[nodiscard]] double value() const;
    [[nodiscard]] double value(double tau) const;
    /// The first and the second derivative at the origin.
    [[nodiscard]] double slope() const;
    [[nodiscard]] double bend() const;
    /// The greatest of its frequencies and rates (per time unit), 0 for a polynomial.
    [[nodiscard]] double fastest() const { return fastest_; }
    /// How long its fastest growing part takes to grow by e; `never` without one.
    [[nodiscard]] double grows_in() const { return growth_ > 0 ? 1 / growth_ : never; }

private:
    [[nodiscard]] double since(double at) const { return (time_ - at) + rest_; }
    void reach(std::size_t power) {
        if (powers_.size() <= power) powers_.resize(power + 1, 0.0);
    }

    double time_ = 0, rest_ = 0, gain_ = 1;
    std::vector<double> powers_ = {0.0};
    std::vector<Sine> sines_;
    std::vector<Exponential> exponentials_;
    double fastest_ = 0, growth_ = 0;
};

/// Whether M has a closed form on each of its smooth stretches.
bool has_closed_form(const Excitation& excitation);

/// The closed form from `time` on, up to the next break after it, counted from `time` + `rest`. Only for an excitation
/// that has one.
void closed_form(const Excitation& excitation, double time, double rest, ClosedForm& sum);

}  // namespace dinal::model
