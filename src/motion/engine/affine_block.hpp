// A block of steps of one body by the classical Runge-Kutta method, as affine maps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "model/excitation.hpp"
#include "motion/engine/affine_step.hpp"
#include "motion/simulate.hpp"

namespace dinal::motion::engine {

/// The fixed steps of a run: step n begins at time(n).
struct StepTimes {
    StepTimes(const Window& of, double step);
    Window window;
    double h;
    std::size_t count;  ///< the last step may be shorter

    [[nodiscard]] double time(std::size_t n) const {
        return n == count ? window.end : window.start + static_cast<double>(n) * h;
    }
    /// Returns the index of the step that contains t or begins at t.
    [[nodiscard]] std::size_t at(double t) const;
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
    [[nodiscard]] model::State end_of(std::size_t i) const { return map(at(i), push_theta[i], push_velocity[i]); }
    [[nodiscard]] model::State at(std::size_t i) const { return {theta[i], velocity[i]}; }
    [[nodiscard]] double acceleration(std::size_t i, const model::State& y) const {
        return forcing[i] - map.c * y.velocity - map.w * y.theta;
    }

    AffineStep map;
    double inverse_inertia;
    Each<2 * most> times{}, samples{};                   ///< at the middle and end of each step
    Each<most + 1> M{}, forcing{}, theta{}, velocity{};  ///< at the start of each step
    Each<most> push_theta{}, push_velocity{};
};

}  // namespace dinal::motion::engine
