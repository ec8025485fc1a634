// The motion inside one smooth step, from position, velocity and acceleration at both ends, and its zeros.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "model/oscillator.hpp"

namespace dinal::motion {

/// The quintic through theta, velocity and acceleration at both ends of a step of length h: theta to O(h^6), velocity
/// to O(h^5), so rows between the steps of a fourth-order method lose nothing.
class StepInterpolant {
public:
    StepInterpolant(double h, const model::State& y0, double a0, const model::State& y1, double a1)
        : h_(h), y0_(y0), a0_(a0) {
        const double p = y1.theta - y0.theta - h * (y0.velocity + h * a0 / 2);
        const double q = h * (y1.velocity - y0.velocity - h * a0);
        const double r = h * h * (a1 - a0);
        c3_ = 10 * p - 4 * q + r / 2;
        c4_ = -15 * p + 7 * q - r;
        c5_ = 6 * p - 3 * q + r / 2;
    }
    /// theta and velocity at the time x after the step's beginning.
    [[nodiscard]] model::State operator()(double x) const {
        const double s = x / h_;
        return {y0_.theta + x * (y0_.velocity + x * a0_ / 2) + s * s * s * (c3_ + s * (c4_ + s * c5_)),
                y0_.velocity + x * a0_ + s * s * (3 * c3_ + s * (4 * c4_ + s * 5 * c5_)) / h_};
    }

private:
    double h_;
    model::State y0_;
    double a0_;
    double c3_, c4_, c5_;
};

/// Improves a zero of the velocity, found by a cubic, by one secant step on the quintic; `slope` is the acceleration
/// there.
struct TurnInStep {
    double x, slope;

    TurnInStep(const StepInterpolant& motion, double h, double zero) : x(zero) {
        const double e = 1e-4 * h;
        slope = (motion(std::min(zero + e, h)).velocity - motion(std::max(zero - e, 0.0)).velocity) / (2 * e);
        const double better = slope != 0 ? zero - motion(zero).velocity / slope : zero;
        if (std::fabs(better - zero) < 0.1 * h && better > 0 && better <= h) x = better;
    }
};

/// Neighbours a < b, at most `width` or one ulp apart, with f(a) <= 0 < f(b), from a bracket with this property. Uses
/// secant steps (Illinois), and bisection every third time, so that a jump costs no more than bisection.
template <class F>
std::pair<double, double> first_positive(F&& f, double a, double fa, double b, double fb, double width = 0) {
    int same_side = 0;
    for (int i = 0; i < 250 && b - a > width; ++i) {
        const double middle = a + (b - a) / 2;
        if (middle <= a || middle >= b) break;
        double x = (a * fb - b * fa) / (fb - fa);
        if (i % 3 == 2 || !(x > a && x < b)) x = middle;
        const double fx = f(x);
        if (fx > 0) {
            b = x, fb = fx;
            if (same_side == 1) fa /= 2;
            same_side = 1;
        } else {
            a = x, fa = fx;
            if (same_side == -1) fb /= 2;
            same_side = -1;
        }
    }
    return {a, b};
}

/// The first time x in (0, h] at which a velocity in `direction` (+1, -1) reaches zero, by the cubic through velocity
/// and acceleration at both ends. A velocity of exactly 0 at the beginning does not count, but 0 is returned if the
/// velocity leaves it in the wrong direction. None if the cubic never reaches zero.
std::optional<double> first_velocity_zero(double direction, double h, double v0, double a0, double v1, double a1);

}  // namespace dinal::motion
