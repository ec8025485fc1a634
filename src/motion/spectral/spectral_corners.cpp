// The spectral engine at the corners of a law of friction: a piece ends where the speed comes to one.
#include <cmath>

#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

std::optional<CornerWatch::Corner> SpectralEngine::first_corner(double until) const {
    if (!corners_.looks()) return {};
    const SolvedPanel& panel = solver_.panel();
    const double rounding = solver_.iterates() ? solver_.rounding() : 0;
    return corners_.first<points + 1>(
        {model::sign_of(standstill_.motion()), panel.v, panel.w, panel.h, rounding, solver_.least_rounding()}, until);
}

/// The speed is at a corner: beyond it another formula holds.
bool SpectralEngine::cross(const CornerWatch::Corner& corner) {
    if (!corners_.cross(corner)) return true;
    const SolvedPanel& panel = solver_.panel();
    const double x = panel.time(corner.x) >= panel.end ? 1 : corner.x;
    const Clock theta = Clock{now_.y.theta, now_.theta_rest}.later(chebyshev::value(panel.p, x));
    now_.theta_rest = theta.lo;
    const model::State state{theta.hi, model::sign_of(standstill_.motion()) * corner.speed};
    end_piece(x, state, x == 1 ? 0 : M_at(x, state));
    standstill_.go_on();
    return std::isfinite(now_.M) || fail(model::Outcome::excitation_not_finite);
}

}  // namespace dinal::motion::spectral
