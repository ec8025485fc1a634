// A block of steps of one body by the classical Runge-Kutta method, as affine maps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "model/excitation.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::engine {

/// One step of I theta'' + C theta' + k theta = F(t) as an affine map. For a linear system the four stages combine to
/// y1 = y0 + (R - 1) y0 + P0 f0 + Pm fm + P1 f1, with f = F/I at the beginning, middle and end of the step, R = 1 + Z +
/// Z^2/2 + Z^3/6 + Z^4/24 and Z = h [0 1; -k/I -C/I] (docs/theory.md). R - 1 is stored rather than R: its rounding is
/// smaller by the factor h w0.
struct AffineStep {
    /// `stiffness` and `damping` are divided by the inertia.
    AffineStep(double stiffness, double damping, double step) : h(step), w(stiffness), c(damping) {
        // Horner: R - 1 = Z (1 + Z/2 (1 + Z/3 (1 + Z/4))), each product by [0 1; -w -c] h.
        double a11 = 1, a12 = 0, a21 = 0, a22 = 1;
        for (int n = 4; n >= 1; --n) {
            const double s = h / n;
            const double b11 = s * a21, b12 = s * a22;
            const double b21 = -s * (w * a11 + c * a21), b22 = -s * (w * a12 + c * a22);
            const double one = n == 1 ? 0 : 1;
            a11 = b11 + one, a12 = b12, a21 = b21, a22 = b22 + one;
        }
        r11 = a11, r12 = a12, r21 = a21, r22 = a22;
        // Second columns of h/6 (1 + Z + Z^2/2 + Z^3/4) and h/6 (4 + 2 Z + Z^2/2); Z e2 = (z1, z2) and so on.
        const double z1 = h, z2 = -c * h;
        const double zz1 = h * z2, zz2 = -h * (w * z1 + c * z2);
        const double zzz1 = h * zz2, zzz2 = -h * (w * zz1 + c * zz2);
        p0 = h / 6 * (z1 + zz1 / 2 + zzz1 / 4), q0 = h / 6 * (1 + z2 + zz2 / 2 + zzz2 / 4);
        pm = h / 6 * (2 * z1 + zz1 / 2), qm = h / 6 * (4 + 2 * z2 + zz2 / 2);
        q1 = h / 6;
    }
    /// The contributions of the forcing to theta and to the velocity.
    double push_theta(double f0, double fm) const { return p0 * f0 + pm * fm; }
    double push_velocity(double f0, double fm, double f1) const { return q0 * f0 + qm * fm + q1 * f1; }
    // NOTE: this order makes the dependency from step to step one product and two sums long.
    [[nodiscard]] model::State operator()(const model::State& y, double push_theta, double push_velocity) const {
        return {(y.theta + push_theta) + (r11 * y.theta + r12 * y.velocity),
                (y.velocity + push_velocity) + (r21 * y.theta + r22 * y.velocity)};
    }
    [[nodiscard]] model::State operator()(const model::State& y, double f0, double fm, double f1) const {
        return (*this)(y, push_theta(f0, fm), push_velocity(f0, fm, f1));
    }

    double h;
    double w, c;  // k/I and C/I
    double r11, r12, r21, r22;
    double p0, pm;
    double q0, qm, q1;
};

/// The fixed steps of a run: step n begins at time(n).
struct StepTimes {
    StepTimes(const Window& of, double step);
    Window window;
    double h;
    std::size_t count;  ///< the last step may be shorter

    double time(std::size_t n) const { return n == count ? window.end : window.start + static_cast<double>(n) * h; }
    /// Returns the index of the step that contains t or begins at t.
    std::size_t at(double t) const;
};

/// Tests for successive steps whether friction holds a mass at rest.
class Hold {
public:
    /// `held` is the torque of the springs, M the load at the start.
    Hold(double forward, double backward, double held, double M)
        : middle_(held + (forward - backward) / 2),
          limit_((forward + backward) / 2 * (1 - 1e-9)),
          off_(std::fabs(M - middle_)) {}
    /// Returns whether the load stays well within the limits during the next step. Between its samples a parabola
    /// exceeds the highest one by at most an eighth of the second difference; a quarter leaves a margin.
    bool lasts(double M_middle, double M_end) {
        const double before = off_, halfway = std::fabs(M_middle - middle_);
        off_ = std::fabs(M_end - middle_);
        return std::max({before, halfway, off_}) + std::fabs(before - 2 * halfway + off_) / 4 < limit_;
    }

private:
    double middle_, limit_, off_;
};

struct AffineBlock {
    static constexpr std::size_t most = 128;  ///< steps per block
    template <std::size_t n>
    using Each = std::array<double, n>;

    AffineBlock(const AffineStep& affine, double inertia) : map(affine), inverse_inertia(1 / inertia) {}
    /// Samples M for `count` steps from step n of the run on. Returns the number of steps with finite samples.
    std::size_t sample(const model::Excitation& M, const StepTimes& steps, std::size_t n, std::size_t count);
    /// Prepares the steps of the block from step i on, which begin at y with load M_there and a constant friction. This
    /// loop is separate from the recurrence, so that it vectorises.
    void begin(std::size_t i, std::size_t count, const model::State& y, double M_there, double friction);
    /// Makes the steps i to `stop` - 1 as long as the velocity certainly keeps its direction. Returns the first step in
    /// which it changes sign, or approaches zero and recedes, as it may then have crossed zero twice.
    std::size_t step(std::size_t i, std::size_t stop, double direction);
    /// Returns the end of step i, in which the velocity may change sign.
    model::State end_of(std::size_t i) const { return map(at(i), push_theta[i], push_velocity[i]); }
    model::State at(std::size_t i) const { return {theta[i], velocity[i]}; }
    double acceleration(std::size_t i, const model::State& y) const {
        return forcing[i] - map.c * y.velocity - map.w * y.theta;
    }

    AffineStep map;
    double inverse_inertia;
    Each<2 * most> times{}, samples{};                   ///< values at the middle and end of each step
    Each<most + 1> M{}, forcing{}, theta{}, velocity{};  ///< values at the start of each step
    Each<most> push_theta{}, push_velocity{};
};

}  // namespace dinal::motion::engine
