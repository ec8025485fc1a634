// A sum of powers, sines, exponentials, a free motion and resonances as a curve over time: walked along in looks, each
// with a bound of what it hides.
//
// It is the velocity on an arc, or the load on a mass at rest.
#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

#include "motion/exact/free_motion.hpp"

namespace dinal::motion::exact {

using Complex = std::complex<double>;

/// Near resonance the answer to exp(mu tau) is told by the divided difference (exp(mu tau) - exp(lambda tau)) /
/// (mu - lambda), which is tau exp(lambda tau) at resonance, instead of by two large numbers that nearly cancel.
struct Resonance {
    Complex mu, from_root;                     ///< mu - lambda
    Complex growing, turning;                  ///< the curve has Im(growing g(tau) + turning exp(mu tau))
    Complex way_growing = 0, way_turning = 0;  ///< and so has the way, of a velocity

    Complex slope_growing = 0, slope_turning = 0;   ///< and so has its slope
    double fourth_growing = 0, fourth_turning = 0;  ///< the sizes of what its fourth derivative has
    void prepare(Complex root);

    /// g(tau), from exp(lambda tau).
    [[nodiscard]] Complex difference(double tau, Complex root_turned) const;
};

class WalkedCurve {
public:
    explicit WalkedCurve(const LinearMotion& free) : free_(free) {}

    struct Value {
        double f = 0, slope = 0;
    };

    // What it is made of. Harmonics first, in the order of `omega`: Im((re + i im) exp(i omega tau)).
    void clear();
    void add_power(double c) { powers_.push_back(c); }
    /// Of a velocity: the powers of the way, which are integrals of its own but for the constant one.
    void add_way_power(double c) { way_powers_.push_back(c); }
    void add_sine(double omega, Complex turning) {
        omega_.push_back(omega);
        re_.push_back(turning.real());
        im_.push_back(turning.imag());
    }
    void add_exponential(double rate, double amount) {
        rate_.push_back(rate);
        amount_.push_back(amount);
    }
    void add_resonance(const Resonance& resonance) { resonances_.push_back(resonance); }
    /// The velocity of a free motion from this state.
    void add_free(double theta, double velocity) { theta_ = theta, velocity_ = velocity, free_part_ = true; }
    /// All is there: the walk begins at 0.
    void begin();

    /// Anywhere, to rounding; the walk stays where it is.
    Value at(double tau) {
        turn_to(tau, other());
        other_place_ = tau;
        return sum(other(), tau);
    }
    /// Of a velocity: the way since the beginning, where at() was asked last.
    [[nodiscard]] double way() const;

    // The walk.
    [[nodiscard]] double place() const { return place_; }
    [[nodiscard]] const Value& here() const { return here_; }
    /// Looks ahead by a length of the table, or any length; and goes there.
    static constexpr int levels = 40;
    [[nodiscard]] double length(int level) const { return lengths_[static_cast<std::size_t>(level)]; }
    const Value& look(int level);
    const Value& look_at(double tau);
    void go() {
        now_ = 1 - now_;
        place_ = next_place_;
        here_ = there_;
    }
    /// What |f''''| does not exceed from here to there.
    [[nodiscard]] double fourth_bound(double until) const;
    /// The size of the numbers that it is the sum of, from here to there.
    [[nodiscard]] double size(double until) const;

private:
    struct State {
        std::vector<double> re, im, amount;
        std::vector<Complex> difference, turned;  // of each resonance
        double theta = 0, velocity = 0;
    };
    struct Turns {
        bool ready = false;
        FreeStep step{};
    };

    void prepare(int level);
    void turn_to(double tau, State& to) const;
    void turn_free(const FreeStep& step, State& to) const;
    [[nodiscard]] Value sum(const State& state, double tau) const;

    const LinearMotion& free_;
    std::vector<double> powers_, way_powers_, omega_, re_, im_, rate_, amount_;
    std::vector<Resonance> resonances_;
    bool free_part_ = false;
    double theta_ = 0, velocity_ = 0;
    double sines_fourth_ = 0, sines_size_ = 0;

    // A turn by the length of each level, made when it is wanted first, for the frequencies and rates that it was made
    // for.
    std::array<double, levels> lengths_{};
    std::array<Turns, levels> turns_{};
    std::vector<double> table_omega_, table_rate_;
    std::vector<double> cosine_, sine_, growth_;
    std::vector<Complex> resonance_mu_, resonance_turn_, resonance_difference_;

    // Two for the walk, which take turns, and one for at().
    std::array<State, 3> states_;
    std::size_t now_ = 0;
    [[nodiscard]] State& now() { return states_[now_]; }
    [[nodiscard]] const State& now() const { return states_[now_]; }
    [[nodiscard]] State& next() { return states_[1 - now_]; }
    [[nodiscard]] State& other() { return states_[2]; }
    [[nodiscard]] const State& other() const { return states_[2]; }
    double place_ = 0, next_place_ = 0, other_place_ = 0;
    Value here_, there_;
};

}  // namespace dinal::motion::exact
