// The rows of a run with more in it.
#include <algorithm>
#include <cmath>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

bool Engine::rows_until(double end, bool to_the_end) {
    const Grid& rows = problem_.rows;
    while (next_row_ < rows.count()) {
        const double t = rows.time(next_row_);
        if (!(t < end) && !(to_the_end && t < piece_.end)) return true;
        if (!put_row(t, std::clamp(piece_.start.until(t) / piece_.h - 1, -1.0, 1.0))) return false;
    }
    return true;
}

/// At x of the piece; -2 is the present.
bool Engine::put_row(double t, double x) {
    const bool present = x < -1;
    const double at = present ? -1 : x;
    Values y = y_;
    if (!present) {
        for (std::size_t k = 0; k < y.size(); ++k) y[k] = at == -1 ? piece_.y[k][0] : piece_.at(k, at);
    }
    const Side side = present || at == -1 ? (after_break_ ? Side::after : Side::at) : Side::at;
    const double belt = field_.belt(t, side);
    const bool stands = standstill_.stuck(), leaning = leans();
    y[0] += origin_;
    if (const auto& walls = problem_.system.walls()) y[0] = std::clamp(y[0], walls->lower, walls->upper);
    if (stands) y[1] = leaning ? 0 : belt;
    const double M = field_.load({t, side, {y[0], y[1]}, {y.data() + 2, y.size() - 2}});
    double friction = 0;
    if (leaning) {
        // The wall carries what presses against it, friction what pulls away from it.
        const double loads = std::fma(-system_.stiffness(), y[0], M - system_.spring(y[0])) + field_.push(t, side);
        const bool presses = loads * model::sign_of(standstill_.leans()) >= 0;
        friction = belt != 0 ? sliding_at_wall(belt) : presses || !system_.dry() ? 0 : -loads;
    } else if (stands) {
        const double rate = !field_.has_belt() ? 0
                            : present          ? field_.belt_slope(t).rate
                                      : spectral::chebyshev::value(spectral::chebyshev::fit(piece_.belt_rate), at);
        friction = system_.inertia() * rate + system_.damping() * belt -
                   (std::fma(-system_.stiffness(), y[0], M - system_.spring(y[0])) + field_.push(t, side));
    } else if (system_.dry()) {
        const model::Motion motion = way();
        friction = 0.0 - (system_.braking(motion) + system_.friction_remainder(motion, {y[0], y[1] - belt}));
    }
    double* row = column_ + next_row_;
    const std::size_t stride = problem_.rows.count();
    const double own[] = {t, y[0], y[1], M, friction, 0.0 - system_.damping() * y[1]};
    if (!std::isfinite(M + friction) || !std::isfinite(y[0]) || !std::isfinite(y[1])) return false;
    for (const double value : own) *row = value, row += stride;
    for (std::size_t k = 2; k < y.size(); ++k) *row = y[k], row += stride;
    ++next_row_;
    return true;
}

}  // namespace dinal::motion::hybrid
