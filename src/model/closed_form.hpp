// M on a smooth stretch as a formula: powers, sines and exponentials of the time since a moment in that stretch.
//
// A native term with a closed form has a function `closed_form(inside, sum)` in its file. It adds to `sum` the term on
// the stretch between two breaks that contains the time `inside`.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "model/excitation.hpp"

namespace dinal::model {

/// A sum of c_n tau^n, of p sin(omega tau) + q cos(omega tau) and of a exp(rate tau). tau is the time since the origin,
/// which is a sum of two doubles.
class ClosedForm {
public:
    /// Clears the sum; the origin is `time` + `rest`.
    void begin(double time, double rest) {
        time_ = time, rest_ = rest;
        powers_.resize(1);
        powers_[0] = 0;
        sines_.clear(), exponentials_.clear();
        fastest_ = growth_ = 0;
    }
    /// Multiplies all terms added from now on.
    void set_gain(double gain) { gain_ = gain; }

    // Called by terms.
    void add_constant(double level) { powers_[0] += gain_ * level; }
    /// A straight line with `level` at the time `at`.
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
    std::span<const double> powers() const { return powers_; }
    struct Sine {
        double omega;
        double in_phase, quadrature;  ///< factors of sin(omega tau) and cos(omega tau)
    };
    std::span<const Sine> sines() const { return sines_; }
    struct Exponential {
        double rate, amount;
    };
    std::span<const Exponential> exponentials() const { return exponentials_; }
    /// The number of sines and exponentials.
    std::size_t turning_parts() const { return sines_.size() + exponentials_.size(); }

    /// M at the origin.
    double value() const;
    double value(double tau) const;
    /// The first and the second derivative at the origin.
    double slope() const;
    double bend() const;
    /// The greatest frequency or rate (per time unit), 0 for a polynomial.
    double fastest() const { return fastest_; }
    /// The time in which the fastest growing part grows by e; `never` if none grows.
    double grows_in() const { return growth_ > 0 ? 1 / growth_ : never; }

private:
    double since(double at) const { return (time_ - at) + rest_; }
    void reach(std::size_t power) {
        if (powers_.size() <= power) powers_.resize(power + 1, 0.0);
    }

    double time_ = 0, rest_ = 0, gain_ = 1;
    std::vector<double> powers_ = {0.0};
    std::vector<Sine> sines_;
    std::vector<Exponential> exponentials_;
    double fastest_ = 0, growth_ = 0;
};

/// Returns whether M has a closed form on each of its smooth stretches.
bool has_closed_form(const Excitation& excitation);

/// Computes the closed form from `time` up to the next break, with the origin `time` + `rest`. Requires
/// has_closed_form(excitation).
void closed_form(const Excitation& excitation, double time, double rest, ClosedForm& sum);

}  // namespace dinal::model
