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

/// The steps of a run: step n begins at time(n).
struct StepTimes {
    StepTimes(const Window& of, double step);
    Window window;
    double h;
    std::size_t count;  ///< the last step may be shorter

    [[nodiscard]] double time(std::size_t n) const {
        return n == count ? window.end : window.start + static_cast<double>(n) * h;
    }
    /// Returns the step in which t lies, or which begins there.
    [[nodiscard]] std::size_t at(double t) const;
};

/// The hold of friction on a mass that stands, from step to step of a load.
class Hold {
public:
    /// `held` is the torque of springs, M the load now.
    Hold(double forward, double backward, double held, double M)
        : middle_(held + (forward - backward) / 2),
          limit_((forward + backward) / 2 * (1 - 1e-9)),
          off_(std::fabs(M - middle_)) {}
    /// Returns whether the load of the next step is well within the limits, also between its samples: a parabola
    /// through three of them exceeds the highest by at most an eighth of their second difference; a quarter is safe.
    bool lasts(double M_middle, double M_end) {
        const double before = off_, halfway = std::fabs(M_middle - middle_);
        off_ = std::fabs(M_end - middle_);
        return std::max({before, halfway, off_}) + std::fabs(before - 2 * halfway + off_) / 4 < limit_;
    }

private:
    double middle_, limit_, off_;
};

struct AffineBlock {
    static constexpr std::size_t most = 128;  ///< steps
    template <std::size_t n>
    using Each = std::array<double, n>;

    AffineBlock(const AffineStep& affine, double inertia) : map(affine), inverse_inertia(1 / inertia) {}
    /// Samples M for the steps n, n + 1, ... of a run. Returns the number of those with finite samples.
    std::size_t sample(const model::Excitation& M, const StepTimes& steps, std::size_t n, std::size_t count);
    /// Prepares the steps from i of the block on, which begin at y under this M and a constant friction. It is separate
    /// from the chain of steps, so that it vectorises.
    void begin(std::size_t i, std::size_t count, const model::State& y, double M_there, double friction);
    /// Steps while the velocity certainly keeps its direction, from step i to before `stop`. Returns the first step in
    /// which it changes sign, or dips towards zero and returns, as it may have crossed zero twice.
    std::size_t step(std::size_t i, std::size_t stop, double direction);
    /// Returns the end of step i, in which the velocity may change sign.
    [[nodiscard]] model::State end_of(std::size_t i) const { return map(at(i), push_theta[i], push_velocity[i]); }
    [[nodiscard]] model::State at(std::size_t i) const { return {theta[i], velocity[i]}; }
    [[nodiscard]] double acceleration(std::size_t i, const model::State& y) const {
        return forcing[i] - map.c * y.velocity - map.w * y.theta;
    }

    AffineStep map;
    double inverse_inertia;
    Each<2 * most> times{}, samples{};                   ///< in the middle and at the end of each step
    Each<most + 1> M{}, forcing{}, theta{}, velocity{};  ///< at the beginning
    Each<most> push_theta{}, push_velocity{};
};

}  // namespace dinal::motion::engine
