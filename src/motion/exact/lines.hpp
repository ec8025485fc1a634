// The motion under a torque that is linear in time, over a short time: one line of a record of samples.
#pragma once

#include <array>
#include <cmath>

#include "motion/exact/free_motion.hpp"

namespace dinal::motion::exact {

/// I q'' + C q' + k q = pull + slope t with q(0) = 0: linear in the initial velocity, pull and slope. Caches the
/// factors for one length, because records are usually sampled evenly.
class LineStep {
public:
    LineStep(const model::Lowered& system, const LinearMotion& free)
        : inertia_(system.inertia()),
          damping_(system.damping()),
          stiffness_(system.stiffness()),
          per_inertia_(1 / inertia_),
          per_w0_(1 / free.w0()),
          longest_(short_of / free.fastest()) {}

    /// The initial values of the interval.
    struct Start {
        double velocity, pull, slope;
    };
    struct End {
        double way, velocity;
        double bend;  ///< bound of |the second derivative of the velocity| on the interval
    };
    /// Returns whether the factors are those of this length. Relative differences up to 1e-9, due to the rounding of
    /// times, are corrected in over().
    [[nodiscard]] bool is_made_for(double length) const {
        constexpr double nearly = 1e-9;
        return std::fabs(length - length_) <= nearly * length_;
    }
    /// Returns whether an interval is short enough (some tenths of a radian), and computes its factors if necessary.
    bool takes(double length) {
        if (is_made_for(length)) return true;
        if (!(length <= longest_)) return false;
        make(length);
        return true;
    }
    /// The values at the end of an interval. Requires takes(length).
    [[nodiscard]] End over(double length, const Start& start) const {
        const auto& [v, P, S] = start;
        const double more = length - length_;
        const double way = (v * way_[0] + S * way_[2]) + P * way_[1];  // this order: the pull is known last
        const double velocity = (v * velocity_[0] + S * velocity_[2]) + P * velocity_[1];
        const double torque = P + S * length_ - damping_ * velocity - stiffness_ * way;
        const double first = (P - damping_ * v) * per_inertia_;
        const double second = (S - damping_ * first - stiffness_ * v) * per_inertia_;
        const double third = (damping_ * second + stiffness_ * first) * per_inertia_;
        // The second derivative is a free motion, whose energy does not grow.
        return {way + more * velocity, velocity + more * (torque * per_inertia_),
                std::fabs(second) + std::fabs(third) * per_w0_};
    }

private:
    static constexpr double short_of = 0.3;
    void make(double length);

    double inertia_, damping_, stiffness_, per_inertia_, per_w0_, longest_;
    double length_ = 0;
    std::array<double, 3> way_{}, velocity_{};  // responses to unit velocity, pull and slope
};

}  // namespace dinal::motion::exact
