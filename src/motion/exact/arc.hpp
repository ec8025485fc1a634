// The closed form of the motion on an arc, an interval on which M has one formula and friction one sign; and a run as
// its arcs.
#pragma once

#include <vector>

#include "model/closed_form.hpp"
#include "model/excitation.hpp"
#include "motion/clock.hpp"
#include "motion/course.hpp"
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
    double cost(const model::ClosedForm& M) const {
        return lasting_rate(M) * static_cast<double>(1 + M.turning_parts());
    }
    /// The longest arc, which limits the accumulated rounding of steps within an arc and of successive arcs.
    double longest(const model::ClosedForm& M) const;

    struct Point {
        double way;  ///< theta minus its initial value
        double velocity;
    };
    [[nodiscard]] Point at(double tau) {
        const double v = velocity_.at(tau).f;
        return {velocity_.way(), v};
    }
    [[nodiscard]] WalkedCurve& velocity() { return velocity_; }
    const LinearMotion& free() const { return free_; }

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
    double fastest_rate(const model::ClosedForm& M) const;
    /// The fastest rate among the parts that do not decay at once.
    double lasting_rate(const model::ClosedForm& M) const { return std::max(free_.lasting(), M.fastest()); }

    model::Lowered system_;
    LinearMotion free_;
    WalkedCurve velocity_;
    std::vector<Answer> answers_;     // to each sine of M
    std::vector<double> way_, load_;  // work space for coefficients
};

/// An arc of a run, or a rest.
struct KeptArc {
    Clock start;
    double length = 0;
    double requested = 0;  ///< requested length, which affects the choice of the closed form
    model::State begin;
    double theta_rest = 0;  ///< rounding error of theta at the start
    double pull = 0;        ///< M - k theta minus the braking of friction, at the start
    model::Motion motion = model::Motion::stuck;
    bool rests = true;
};

/// All arcs of a run, in order and without gaps; the initial values of each determine its closed form.
class Arcs final : public Course {
public:
    /// `most_bytes` limits the memory; later arcs are dropped.
    Arcs(const model::Oscillator& system, const model::Excitation& excitation, std::size_t most_bytes)
        : Course(system), excitation_(excitation), most_(most_bytes / sizeof(KeptArc)) {
        constexpr std::size_t few = 8;
        arcs_.reserve(few);
    }

    void add(const KeptArc& arc) {
        if (arcs_.size() >= most_) complete_ = false;
        if (complete_) arcs_.push_back(arc);
    }

    text::Expected<model::State> at(double t) const override;
    double whole_until() const override;
    void legs(const std::function<void(const Leg&)>& visit) const override;
    std::size_t bytes() const override { return arcs_.size() * sizeof(KeptArc); }

private:
    double end() const { return arcs_.back().start.after(arcs_.back().length); }

    model::Excitation excitation_;
    std::size_t most_;
    bool complete_ = true;
    std::vector<KeptArc> arcs_;
};

}  // namespace dinal::motion::exact
