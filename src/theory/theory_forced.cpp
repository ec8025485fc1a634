#include "theory/theory_forced.hpp"

#include <cmath>
#include <numbers>

namespace dinal::theory {

namespace {
using std::numbers::pi;
}  // namespace

double magnification(double r, double zeta) {
    return 1 / std::hypot(detuning(r), 2 * zeta * r);
}

double phase_lag(double r, double zeta) {
    return r == 1 ? pi / 2 : std::atan2(2 * zeta * r, detuning(r));
}

// With zeta + zeta_eq instead of zeta, (1 - r^2)^2 Phi^2 + (2 zeta r Phi + g)^2 = 1, g = 4 gamma/pi: the positive root,
// in a form without subtraction.
std::optional<Harmonic_motion> linearised_friction(double r, double zeta, double friction_ratio) {
    const double g = 4 * friction_ratio / pi;
    if (!(g < 1)) return {};
    const double d = detuning(r);
    const double c = 2 * zeta * r;
    const double rest = (1 - g) * (1 + g);
    const double amplitude = rest / (c * g + std::hypot(d * std::sqrt(rest), c));
    if (!std::isfinite(amplitude)) return Harmonic_motion{amplitude, pi / 2};
    return Harmonic_motion{amplitude, std::atan2(c * amplitude + g, d * amplitude)};
}

}  // namespace dinal::theory
