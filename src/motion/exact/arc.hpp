// The closed form of the motion on an arc, an interval on which M has one formula and friction one sign.
#pragma once

#include "model/closed_form.hpp"
#include "motion/exact/curve.hpp"

namespace dinal::motion::exact {

class Arc {
public:
    explicit Arc(const model::Lowered& system) : system_(system), free_(system), velocity_(free_) {}

    /// The initial values: `pull` is M - k theta minus the braking of friction.
    struct Start {
        double velocity, pull;
    };
    /// Begins an arc of the requested `length` at the origin of M. Returns the length for which the closed form is
    /// valid, which may be shorter to avoid cancellation.
    double begin(const model::ClosedForm& M, const Start& start, double length);
    /// An upper estimate of the cost of a time unit: radians of the fastest part times the number of oscillating parts.
    /// Does not count parts of an overdamped system that decay at once.
    [[nodiscard]] double cost(const model::ClosedForm& M) const {
        return lasting_rate(M) * static_cast<double>(1 + M.turning_parts());
    }
    /// The longest arc, which limits the accumulated rounding of steps within an arc and of successive arcs.
    [[nodiscard]] double longest(const model::ClosedForm& M) const;

    struct Point {
        double way;  ///< theta minus its initial value
        double velocity;
    };
    [[nodiscard]] Point at(double tau) {
        const double v = velocity_.at(tau).f;
        return {velocity_.way(), v};
    }
    [[nodiscard]] WalkedCurve& velocity() { return velocity_; }
    [[nodiscard]] const LinearMotion& free() const { return free_; }

private:
    /// The response to exp(i omega tau).
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
    /// The fastest rate among the parts that do not decay at once.
    [[nodiscard]] double lasting_rate(const model::ClosedForm& M) const {
        return std::max(free_.lasting(), M.fastest());
    }

    model::Lowered system_;
    LinearMotion free_;
    WalkedCurve velocity_;
    std::vector<Answer> answers_;     // to each sine of M
    std::vector<double> way_, load_;  // work space for coefficients
};

}  // namespace dinal::motion::exact
