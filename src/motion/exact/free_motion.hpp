// The free motion of the linear part, theta'' + 2 delta theta' + w0^2 theta = 0, over any time and at any damping.
#pragma once

#include <cmath>
#include <complex>
#include <limits>

#include "model/lowered.hpp"

namespace dinal::motion::exact {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// theta = along theta0 + moved velocity0, velocity = -w0^2 moved theta0 + kept velocity0.
struct FreeStep {
    double along, moved, kept;
};

/// A free motion at some time, as it is followed: theta and velocity, or, of a system far above critical damping, what
/// is slow and what is fast of its velocity: the slow velocity is w0 theta/(2 zeta), and would drown in the roundings
/// of w0 theta.
struct FreeParts {
    double first, second;
};

class LinearMotion {
public:
    explicit LinearMotion(const model::Lowered& system);

    [[nodiscard]] double w0() const { return w0_; }
    [[nodiscard]] double w0_squared() const { return w0_squared_; }
    [[nodiscard]] double delta() const { return delta_; }
    [[nodiscard]] double twice_delta() const { return 2 * delta_; }
    /// Of the faster of its two parts, per time unit: no derivative grows faster.
    [[nodiscard]] double fastest() const { return fastest_; }
    /// Of the parts that are not soon gone: it is what rounding makes of an angle in the velocity, too.
    [[nodiscard]] double lasting() const { return apart_ ? slow_ : w0_; }
    /// How fast the slowest of its parts decays, per time unit.
    [[nodiscard]] double decay() const { return slow_; }
    [[nodiscard]] FreeStep after(double tau) const;

    /// When the velocity of a motion comes to zero first that begins with this velocity and acceleration, not both 0,
    /// and goes on freely about any place; `never` when it does not.
    [[nodiscard]] double turns_after(double velocity, double acceleration) const;

    // The same motion by its parts:
    [[nodiscard]] FreeParts parts(double theta, double velocity) const;
    /// Its step, of which first and second are theta and velocity.
    [[nodiscard]] FreeStep parts_after(double tau) const;
    [[nodiscard]] double velocity(const FreeParts& at) const { return apart_ ? at.first + at.second : at.second; }
    [[nodiscard]] double acceleration(const FreeParts& at) const {
        return by_first_ * at.first + by_second_ * at.second;
    }
    [[nodiscard]] double theta(const FreeParts& at) const {
        return apart_ ? -(at.first / slow_ + at.second / fast_) : at.first;
    }
    [[nodiscard]] FreeParts derivative(const FreeParts& at) const {
        if (apart_) return {-slow_ * at.first, -fast_ * at.second};
        return {at.second, acceleration(at)};
    }
    /// What |the fourth derivative of the velocity| does not exceed from here on, and the size of the numbers that the
    /// velocity is the sum of.
    [[nodiscard]] double fourth_bound(const FreeParts& at) const;
    [[nodiscard]] double size(const FreeParts& at) const {
        return std::fabs(at.second) + (apart_ ? 1 : w0_) * std::fabs(at.first);
    }

    // Of a system that swings:
    [[nodiscard]] bool swings() const { return swings_; }
    /// lambda = -delta + i w1; how far i omega is from it, without the rounding of w1.
    [[nodiscard]] std::complex<double> root() const { return {-delta_, w1_}; }
    [[nodiscard]] std::complex<double> from_root(double omega) const { return {delta_, (omega - w1_) - w1_rest_}; }
    /// exp(lambda tau)
    [[nodiscard]] std::complex<double> turned(double tau) const;
    /// The step of that turn.
    [[nodiscard]] FreeStep step(std::complex<double> turned) const {
        const double moved = turned.imag() / w1_;
        return {turned.real() + delta_ * moved, moved, turned.real() - delta_ * moved};
    }

private:
    double delta_, w0_, w0_squared_;
    double w1_ = 0, w1_rest_ = 0;  // sqrt |w0^2 - delta^2|, and what that lacks
    double slow_ = 0, fast_ = 0;   // of an overdamped system: its two rates
    bool swings_;
    bool apart_;  // its two parts are followed each by itself
    double fastest_;
    double by_first_, by_second_;  // the acceleration, for each part
    double energy_fourth_;         // of |v''''|, for a speed of 1 or an angle of 1/w0
};

}  // namespace dinal::motion::exact
