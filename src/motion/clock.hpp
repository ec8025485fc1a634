// Numbers in two doubles: a time, which stays accurate over tens of thousands of restarts, and the sum of many numbers.
#pragma once

#include <cmath>

namespace dinal::motion {

struct Clock {
    double hi = 0;  ///< the time, rounded
    double lo = 0;  ///< its rounding error

    /// The time `dt` later, rounded once.
    double after(double dt) const { return hi + (lo + dt); }
    /// The duration from this time to t.
    double until(double t) const { return (t - hi) - lo; }
    Clock later(double dt) const {
        const double sum = hi + dt;
        const double part = sum - hi;
        const double rest = lo + ((hi - (sum - part)) + (dt - part));
        const double time = sum + rest;
        return {time, rest - (time - sum)};
    }
};

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

}  // namespace dinal::motion
