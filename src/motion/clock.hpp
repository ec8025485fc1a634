// A time in two doubles, which stays accurate over tens of thousands of restarts.
#pragma once

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

}  // namespace dinal::motion
