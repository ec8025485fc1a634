// The motion on an arc, a stretch on which M has one formula and friction one sign, as a closed form.
#pragma once

#include "model/closed_form.hpp"
#include "motion/exact/curve.hpp"

namespace dinal::motion::exact {

class Arc {
public:
    explicit Arc(const model::Lowered& system) : system_(system), free_(system), velocity_(free_) {}

    /// How the motion begins: `pull` is M - k theta less the braking of friction.
    struct Start {
        double velocity, pull;
    };
    /// The arc under M from its origin on, which is wanted for `length`. Returns for how long it holds: less where
    /// numbers that nearly cancel must be avoided.
    double begin(const model::ClosedForm& M, const Start& start, double length);
    /// What a time unit of the arc costs at most, about: radians of its fastest part times the parts that turn. What
    /// an overdamped system forgets at once does not.
    [[nodiscard]] double cost(const model::ClosedForm& M) const {
        return lasting_rate(M) * static_cast<double>(1 + M.turning_parts());
    }
    /// Where an arc without events ends, that what its looks round does not add up; and what the arcs round adds up.
    [[nodiscard]] double longest(const model::ClosedForm& M) const;

    struct Point {
        double way;  ///< theta less that of the beginning
        double velocity;
    };
    [[nodiscard]] Point at(double tau) {
        const double v = velocity_.at(tau).f;
        return {velocity_.way(), v};
    }
    [[nodiscard]] WalkedCurve& velocity() { return velocity_; }
    [[nodiscard]] const LinearMotion& free() const { return free_; }

private:
    /// What the system makes of exp(i omega tau).
    struct Answer {
        double omega = 0;
        bool resonant = false;
        Complex gain = 0, other_gain = 0, from_root = 0;
        double fourth_growing = 0, fourth_turning = 0;
    };
    void answer(std::size_t j, double omega);
    bool begin_powers(const model::ClosedForm& M, double still, double length, double& theta, double& velocity);
    bool begin_closed(const model::ClosedForm& M, const Start& start, double length);
    void begin_series(const model::ClosedForm& M, const Start& start, double length, double rate);
    [[nodiscard]] double fastest_rate(const model::ClosedForm& M) const;
    /// Of the parts that are not forgotten at once.
    [[nodiscard]] double lasting_rate(const model::ClosedForm& M) const {
        return std::max(free_.lasting(), M.fastest());
    }

    model::Lowered system_;
    LinearMotion free_;
    WalkedCurve velocity_;
    std::vector<Answer> answers_;     // to each sine of M
    std::vector<double> way_, load_;  // coefficients at work
};

}  // namespace dinal::motion::exact
