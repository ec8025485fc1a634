// The motion under a torque that is a straight line, over a short time: what a record of samples is made of.
#pragma once

#include <array>
#include <cmath>

#include "motion/exact/free_motion.hpp"

namespace dinal::motion::exact {

/// I q'' + C q' + k q = pull + slope t, from q = 0: linear in the velocity, the pull and the slope at the beginning.
/// The factors are those of one length, as records are mostly sampled evenly.
class LineStep {
public:
    LineStep(const model::Lowered& system, const LinearMotion& free)
        : inertia_(system.inertia()),
          damping_(system.damping()),
          stiffness_(system.stiffness()),
          per_inertia_(1 / inertia_),
          per_w0_(1 / free.w0()),
          longest_(short_of / free.fastest()) {}

    /// How the stretch begins.
    struct Start {
        double velocity, pull, slope;
    };
    struct End {
        double way, velocity;
        double bend;  ///< what |the second derivative of the velocity| does not exceed on the way
    };
    /// Whether the factors are those of this length, or nearly: times are rounded, and by a part of 1e-9 they are
    /// turned to what they are without losing a digit.
    [[nodiscard]] bool is_made_for(double length) const {
        constexpr double nearly = 1e-9;
        return std::fabs(length - length_) <= nearly * length_;
    }
    /// Whether a stretch is short enough for the factors: some tenths of a radian. They are made if they are not.
    bool takes(double length) {
        if (is_made_for(length)) return true;
        if (!(length <= longest_)) return false;
        make(length);
        return true;
    }
    /// Over a stretch that it takes.
    [[nodiscard]] End over(double length, const Start& start) const {
        const auto& [v, P, S] = start;
        const double more = length - length_;
        const double way = (v * way_[0] + S * way_[2]) + P * way_[1];  // the pull is known last
        const double velocity = (v * velocity_[0] + S * velocity_[2]) + P * velocity_[1];
        const double torque = P + S * length_ - damping_ * velocity - stiffness_ * way;
        const double first = (P - damping_ * v) * per_inertia_;
        const double second = (S - damping_ * first - stiffness_ * v) * per_inertia_;
        const double third = (damping_ * second + stiffness_ * first) * per_inertia_;
        // The second derivative is a free motion, and the energy of that does not grow.
        return {way + more * velocity, velocity + more * (torque * per_inertia_),
                std::fabs(second) + std::fabs(third) * per_w0_};
    }

private:
    static constexpr double short_of = 0.3;
    void make(double length);

    double inertia_, damping_, stiffness_, per_inertia_, per_w0_, longest_;
    double length_ = 0;
    std::array<double, 3> way_{}, velocity_{};  // for a velocity, a pull and a slope of 1
};

}  // namespace dinal::motion::exact
