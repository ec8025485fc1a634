// Panels under feedback: M(t, theta, velocity) and the motion, each from the other.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

constexpr int most_iterations = 25;
constexpr double rounding_left = 100;  // by an iteration that does not get better

}  // namespace

/// The torque that depends on the motion, M(t, theta, velocity) and a friction's remainder, and the motion: each from
/// the other until they agree.
PanelSolver::Iteration PanelSolver::iterate(const model::State& departing) {
    for (const bool again : {false, true}) {
        if (!well_conditioned()) break;
        chebyshev::Samples p{}, v{};
        const bool predicted = steps_.predicted && !again, sampled_already = steps_.sampled && !again;
        if (predicted) {
            p = chebyshev::at_nodes(panel_.p), v = chebyshev::at_nodes(panel_.v);
        } else {
            for (std::size_t j = 0; j < points; ++j) {
                v[j] = panel_.h * panel_.begin.velocity;
                p[j] = (1 + chebyshev::nodes[j]) * v[j];
            }
        }
        double change = model::never;
        for (int i = 0; i < most_iterations; ++i) {
            chebyshev::Samples rest{};
            for (std::size_t j = 0; j < points; ++j) {
                const model::State state{panel_.begin.theta + p[j], v[j] / panel_.h};
                const bool asked = i == 0 && (sampled_already || (predicted && j == 0));
                if (!asked) panel_.samples[j] = sampled(j, j == 0 ? departing : state);
                if (!std::isfinite(panel_.samples[j])) return Iteration::failed;
                rest[j] = panel_.samples[j] - remainder(state) + falls_.theta * p[j] + falls_.velocity * state.velocity;
                if (!std::isfinite(rest[j])) return Iteration::failed;  // a law of friction that a user wrote
            }
            panel_.M = chebyshev::fit(panel_.samples);  // its size is wanted if this is to go on
            const Series torque = chebyshev::fit(rest);
            solve_for(torque);
            const auto p_next = chebyshev::at_nodes(panel_.p), v_next = chebyshev::at_nodes(panel_.v);
            const double before = change;
            change = 0;
            for (std::size_t j = 0; j < points; ++j) {
                change = std::max({change, std::fabs(p_next[j] - p[j]), std::fabs(v_next[j] - v[j])});
            }
            p = p_next, v = v_next;
            const double scale = chebyshev::size(panel_.v) + chebyshev::size(panel_.p);
            if (!(change < model::never)) break;
            // What is left shrinks by change/before once more with the solution just made.
            const double rate = before < model::never ? change / before : 1;
            const double rounding = std::max(16 * epsilon * scale, rounding_of_motion(noise_));
            bool converged = change <= rounding || change * rate <= 0.01 * tolerance_ * scale;
            if (!converged && i >= 2 && change > 0.5 * before) {
                if (change > rounding_left * rounding) break;
                converged = true;  // it does not get better than that
            }
            if (converged) {
                take_M(torque);
                return Iteration::converged;
            }
        }
        if (!again) estimate_slopes();
    }
    falls_.theta = falls_.velocity = 0;  // a shorter panel begins without them: they may be what is wrong
    return Iteration::diverges;
}

/// Whether a panel's equation can be solved with the slopes of the feedback in it. Negative ones make the motion grow
/// from one end of the panel to the other: more than a little is none that a polynomial follows.
bool PanelSolver::well_conditioned() const {
    constexpr double most = 4;
    const double a = panel_.h * ((system_.damping() + falls_.velocity + slope_of_line()) / system_.inertia());
    const double b = panel_.h * (panel_.h * ((system_.stiffness() + falls_.theta) / system_.inertia()));
    return a >= -most && std::fabs(b) <= most;
}

/// M as it acts on the motion just found: what was iterated and the linear part, which was solved for, but for what
/// of them is friction.
void PanelSolver::take_M(const Series& iterated) {
    for (std::size_t k = 0; k < points; ++k)
        panel_.M[k] = iterated[k] - falls_.theta * panel_.p[k] - falls_.velocity * (panel_.v[k] / panel_.h);
    if (!system_.has_remainder()) return;
    const auto p = chebyshev::at_nodes(panel_.p), v = chebyshev::at_nodes(panel_.v);
    chebyshev::Samples friction{};
    for (std::size_t j = 0; j < points; ++j) friction[j] = remainder({panel_.begin.theta + p[j], v[j] / panel_.h});
    const Series series = chebyshev::fit(friction);
    for (std::size_t k = 0; k < points; ++k) panel_.M[k] += series[k];
}

/// How M depends on theta and velocity, by secants as wide as the motion on this panel: that of the last iteration, but
/// no wider than the torques at its beginning can make it.
void PanelSolver::estimate_slopes() {
    const double t = panel_.start.hi, h = panel_.h;
    const double torque = std::fabs(panel_.samples[0]) + system_.stiffness() * std::fabs(panel_.begin.theta) +
                          std::fabs(system_.braking(panel_.motion));
    const double fastest = std::fabs(panel_.begin.velocity) + h * torque / system_.inertia();
    const double d_theta =
        std::max(std::min(chebyshev::size(panel_.p), 2 * h * fastest), 1e-6 * std::fabs(panel_.begin.theta));
    const double d_velocity =
        std::max(std::min(chebyshev::size(panel_.v) / h, fastest), 1e-6 * std::fabs(panel_.begin.velocity));
    const auto slope = [](double above, double below, double d) {
        const double s = d > 0 && d < model::never ? (below - above) / (2 * d) : 0;
        return std::isfinite(s) ? s : 0;
    };
    const auto torque_at = [&](const model::State& state) { return excitation_.value(t, state) - remainder(state); };
    falls_.theta = slope(torque_at({panel_.begin.theta + d_theta, panel_.begin.velocity}),
                         torque_at({panel_.begin.theta - d_theta, panel_.begin.velocity}), d_theta);
    falls_.velocity = slope(torque_at({panel_.begin.theta, panel_.begin.velocity + d_velocity}),
                            torque_at({panel_.begin.theta, panel_.begin.velocity - d_velocity}), d_velocity);
}

}  // namespace dinal::motion::spectral
