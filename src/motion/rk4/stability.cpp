// The stability limit of RK4's step.

#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "motion/rk4/rk4.hpp"

namespace dinal::motion::rk4 {

namespace {

/// |R(z)| - 1 for RK4's R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24, accurate for small z: |R|^2 - 1 = 2 Re(w) + |w|^2 with w
/// = R - 1.
double amplification_excess(std::complex<double> z) {
    const std::complex<double> w = z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)));
    return 2 * w.real() + std::norm(w);
}

/// The boundary of RK4's stability region in the direction of `lambda` (a unit vector, left half-plane).
double stable_radius(std::complex<double> lambda) {
    if (lambda.real() == 0) return 2 * std::numbers::sqrt2;  // on this axis the excess is r^6 (r^2/8 - 1)/72
    double inside = 0;
    double outside = 4;  // the region ends before |z| = 3.4 in every direction
    // The region is star-shaped about 0 in the left half-plane, so bisection finds the only boundary.
    for (int i = 0; i < 60; ++i) {
        const double r = (inside + outside) / 2;
        (amplification_excess(r * lambda) <= 0 ? inside : outside) = r;
    }
    return inside;
}

}  // namespace

double stability_limit(const model::Oscillator& system) {
    if (!system.has_spring()) return stable_radius({-1, 0}) / (system.damping() / system.inertia());
    const double w0 = system.natural_frequency();
    const double zeta = system.damping_ratio();
    if (zeta < 1) {
        return stable_radius({-zeta, std::sqrt((1 - zeta) * (1 + zeta))}) / w0;
    }
    // Both roots are real: the fast one decides.
    return stable_radius({-1, 0}) / (w0 * (zeta + std::sqrt((zeta - 1) * (zeta + 1))));
}

std::optional<text::Error> Rk4::wrong_for(const model::Oscillator& system,
                                          const model::Excitation& /*excitation*/) const {
    const double limit = stability_limit(system);
    // A step that equals the limit to the printed digits is accepted.
    if (h <= limit * (1 + 1e-12)) return {};
    if (!system.has_spring()) {
        return text::Error{
            .sentence = fmt::format("h = {:.6g} exceeds the stability limit {:.6g} of rk4 (C/I = {:.6g}): "
                                    "use h <= {:.3g}",
                                    h, limit, system.damping() / system.inertia(), 0.999 * limit),
            .option = "h"};
    }
    return text::Error{
        .sentence = fmt::format(
            "h = {:.6g} exceeds the stability limit {:.6g} of rk4 (w0 = {:.6g}, zeta = {:.4g}): use h <= {:.3g}", h,
            limit, system.natural_frequency(), system.damping_ratio(), 0.999 * limit),
        .option = "h"};
}

}  // namespace dinal::motion::rk4
