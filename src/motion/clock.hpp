// A time that twenty thousand restarts do not blur: a double and what it lacks.
#pragma once

namespace dinal::motion {

struct Clock {
    double hi = 0;  ///< the time, rounded
    double lo = 0;  ///< what was rounded off

    /// The time `dt` later, rounded once.
    [[nodiscard]] double after(double dt) const { return hi + (lo + dt); }
    /// How long ago this is at time t.
    [[nodiscard]] double until(double t) const { return (t - hi) - lo; }
    [[nodiscard]] Clock later(double dt) const {
        const double sum = hi + dt;
        const double part = sum - hi;
        const double rest = lo + ((hi - (sum - part)) + (dt - part));
        const double time = sum + rest;
        return {time, rest - (time - sum)};
    }
};

}  // namespace dinal::motion
