// The free motion of the linear part, theta'' + 2 delta theta' + w0^2 theta = 0, over any time and with any damping.
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

/// The coordinates of a free motion: theta and velocity, or far above critical damping the slow and fast parts of the
/// velocity, because there the slow velocity, w0 theta/(2 zeta), is below the rounding of w0 theta.
struct FreeParts {
    double first, second;
};

class LinearMotion {
public:
    explicit LinearMotion(const model::Lowered& system);

    double w0() const { return w0_; }
    double w0_squared() const { return w0_squared_; }
    /// The rate of the faster part of the motion, per time unit, which bounds the growth of derivatives.
    double fastest() const { return fastest_; }
    /// The rate of the slow part if the two rates are far apart, otherwise w0; it also converts rounding of an angle to
    /// that of a velocity.
    double lasting() const { return apart_ ? slow_ : w0_; }
    /// The decay rate of its slowest part, per time unit.
    double decay() const { return slow_; }
    FreeStep after(double tau) const;

    // The motion in FreeParts:
    FreeParts parts(double theta, double velocity) const;
    /// The step for FreeParts.
    FreeStep parts_after(double tau) const;
    double velocity(const FreeParts& at) const { return apart_ ? at.first + at.second : at.second; }
    double acceleration(const FreeParts& at) const { return by_first_ * at.first + by_second_ * at.second; }
    double theta(const FreeParts& at) const { return apart_ ? -(at.first / slow_ + at.second / fast_) : at.first; }
    FreeParts derivative(const FreeParts& at) const {
        if (apart_) return {-slow_ * at.first, -fast_ * at.second};
        return {at.second, acceleration(at)};
    }
    /// Bounds of |the fourth derivative of the velocity| and of the terms of the velocity, from here on.
    double fourth_bound(const FreeParts& at) const;
    double size(const FreeParts& at) const { return std::fabs(at.second) + (apart_ ? 1 : w0_) * std::fabs(at.first); }

    // For an oscillating system:
    bool swings() const { return swings_; }
    /// lambda = -delta + i w1, and i omega - lambda without the rounding of w1.
    std::complex<double> root() const { return {-delta_, w1_}; }
    std::complex<double> from_root(double omega) const { return {delta_, (omega - w1_) - w1_rest_}; }
    /// exp(lambda tau)
    std::complex<double> turned(double tau) const;
    /// The step that corresponds to exp(lambda tau).
    FreeStep step(std::complex<double> turned) const {
        const double moved = turned.imag() / w1_;
        return {turned.real() + delta_ * moved, moved, turned.real() - delta_ * moved};
    }

private:
    double delta_, w0_, w0_squared_;
    double w1_ = 0, w1_rest_ = 0;  // sqrt |w0^2 - delta^2| and its rounding error
    double slow_ = 0, fast_ = 0;   // both rates of an overdamped system
    bool swings_;
    bool apart_;  // whether its two parts are stored separately
    double fastest_;
    double by_first_, by_second_;  // acceleration per unit of each part
    double energy_fourth_;         // bound of |v''''| for a speed of 1 or an angle of 1/w0
};

}  // namespace dinal::motion::exact
