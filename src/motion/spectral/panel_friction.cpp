// Panels under a law of friction that names its corners: how long the next one may be, and the motion along a formula
// that is no line.
#include <algorithm>
#include <cmath>

#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

constexpr int most_rounds = 25;

}  // namespace

/// A panel no longer than its friction can be followed.
void PanelSolver::foresee_friction(const Present& now, model::Motion way) {
    const double I = system_.inertia(), C = system_.damping(), sign = model::sign_of(way), v = now.y.velocity;
    const double friction = system_.braking(way) + slide_.friction_remainder(system_, way, now.y);
    const double first = (now.M - friction - C * v - system_.pull_back(now.y.theta)) / I;
    const double second = (std::fabs(system_.stiffness() * v) + std::fabs(C * first)) / I;
    h_ = std::min(h_, slide_.longest_step(sign * v, sign * first, second, C, I) / 2);
}

/// The motion under M, a function of time, and friction that bends: each from the other, with a mean slope of friction
/// solved for. False when they do not come together.
bool PanelSolver::follow_friction(const Present& now) {
    const double h = panel_.h, inertia = system_.inertia(), sign = model::sign_of(panel_.motion);
    const model::Friction& law = *slide_.law();
    const auto friction = [&](double v) { return law.sliding(panel_.motion, sign * v); };
    // A parabola to begin with.
    const double v0 = now.y.velocity;
    const double first =
        (panel_.samples[0] - sign * friction(v0) - system_.damping() * v0 - system_.pull_back(panel_.begin.theta)) /
        inertia;
    double rise = 0;
    for (std::size_t k = 1; k < points; ++k) {
        rise += (k % 2 == 1 ? 1 : -1) * static_cast<double>(k * k) * panel_.M[k];
    }
    const double second =
        (rise / h - system_.stiffness() * v0 - (system_.damping() + law.slope(sign * v0)) * first) / inertia;
    chebyshev::Samples v{};
    for (std::size_t j = 0; j < points; ++j) {
        const double t = h * (1 + chebyshev::nodes[j]);
        v[j] = h * (v0 + t * (first + t * second / 2));
    }
    const double change_of_v = (v[points - 1] - v[0]) / h;
    falls_.theta = 0;
    falls_.velocity =
        change_of_v != 0 ? sign * (friction(v[points - 1] / h) - friction(v0)) / change_of_v : law.slope(sign * v0);
    if (!std::isfinite(falls_.velocity) || !well_conditioned()) falls_.velocity = 0;
    const double braking = system_.braking(panel_.motion);
    double change = model::never;
    for (int i = 0; i < most_rounds; ++i) {
        chebyshev::Samples rest{};
        for (std::size_t j = 0; j < points; ++j) {
            const double velocity = v[j] / h;
            rest[j] = panel_.samples[j] - (sign * friction(velocity) - braking) + falls_.velocity * velocity;
        }
        solve_for(chebyshev::fit(rest));
        const auto next = chebyshev::at_nodes(panel_.v);
        const double before = change;
        change = 0;
        for (std::size_t j = 0; j < points; ++j) change = std::max(change, std::fabs(next[j] - v[j]));
        v = next;
        if (!(change < model::never)) return false;
        const double scale = chebyshev::size(panel_.v) + chebyshev::size(panel_.p);
        const double rate = before < model::never ? change / before : 1;
        const double rounding = std::max(16 * epsilon * scale, rounding_of_motion(noise_));
        if (change <= rounding || change * rate <= 0.01 * tolerance_ * scale) return true;
        if (i >= 2 && rate > 0.5) {
            constexpr double still_rounding = 100;
            return change <= still_rounding * rounding;
        }
    }
    return false;
}

}  // namespace dinal::motion::spectral
