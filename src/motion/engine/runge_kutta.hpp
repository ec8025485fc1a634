// Runge-Kutta methods: a stretch is one step, of the classical method or of an embedded pair.
#pragma once

#include <vector>

#include "motion/engine/flow.hpp"

namespace dinal::motion::engine {

class RungeKutta final : public Flow {
public:
    /// Uses the classical method with this step, or the pair if it is not null.
    RungeKutta(const Mechanics& mechanics, double tolerance, double longest, double step, const Pair* pair)
        : Flow(mechanics, tolerance, longest), step_(step), pair_(pair) {}
    double gap(const Segment& segment) const override { return pair_ == nullptr ? segment.h : Flow::gap(segment); }

private:
    Attempt find(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing) override;
    Attempt accept(Segment& segment, const Mode& mode, const Frame& frame) override;
    bool follows_rates() const override { return false; }

    template <class Rates>
    bool find_stages(Segment& segment, const Rates& rates, std::vector<double>& change);
    double error_of_step(const Segment& segment, const Frame& frame) const;

    double step_;
    const Pair* pair_;
    /// The last step of a pair.
    struct {
        std::vector<std::vector<double>> stages{};  ///< slopes of the groups and states
        std::vector<double> error{}, bulge{};
    } last_;
};

}  // namespace dinal::motion::engine
