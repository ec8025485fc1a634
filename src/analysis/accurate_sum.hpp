// The sum of many numbers without the rounding errors of its steps.
#pragma once

#include <cmath>

namespace dinal::analysis {

/// Neumaier's sum: collects the rounding errors and adds them at the end.
class AccurateSum {
public:
    void add(double x) {
        const double next = sum_ + x;
        lost_ += std::fabs(sum_) >= std::fabs(x) ? (sum_ - next) + x : (x - next) + sum_;
        sum_ = next;
    }
    double value() const { return std::isfinite(lost_) ? sum_ + lost_ : sum_; }

private:
    double sum_ = 0, lost_ = 0;
};

}  // namespace dinal::analysis
