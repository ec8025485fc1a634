// The spectral engine's panels under feedback: M(t, theta, velocity) and the motion, each from the other.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr int most_iterations = 25;

}  // namespace

/// The torque that depends on the motion, M(t, theta, velocity) and a friction's remainder, and the motion: each from
/// the other until they agree.
SpectralEngine::Iteration SpectralEngine::iterate() {
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    for (const bool again : {false, true}) {
        if (!well_conditioned()) break;
        chebyshev::Samples p{}, v{};
        for (std::size_t j = 0; j < points; ++j) {
            v[j] = panel_.h * y_.velocity;
            p[j] = (1 + chebyshev::nodes[j]) * v[j];
        }
        double change = model::never;
        for (int i = 0; i < most_iterations; ++i) {
            chebyshev::Samples rest{};
            for (std::size_t j = 0; j < points; ++j) {
                const model::State state{y_.theta + p[j], v[j] / panel_.h};
                samples_[j] = sampled(j, j == 0 && leaving ? standstill_.on_its_way(state) : state);
                if (!std::isfinite(samples_[j])) return Iteration::failed;
                rest[j] = samples_[j] - remainder(state) + kappa_ * p[j] + chi_ * state.velocity;
            }
            panel_.M = chebyshev::fit(samples_);  // its size is wanted if this is to go on
            const Series torque = chebyshev::fit(rest);
            solve_for(torque);
            const auto p_next = chebyshev::at_nodes(p_), v_next = chebyshev::at_nodes(v_);
            const double before = change;
            change = 0;
            for (std::size_t j = 0; j < points; ++j) {
                change = std::max({change, std::fabs(p_next[j] - p[j]), std::fabs(v_next[j] - v[j])});
            }
            p = p_next, v = v_next;
            const double scale = chebyshev::size(v_) + chebyshev::size(p_);
            if (!(change < model::never)) break;
            // What is left shrinks by change/before once more with the solution just made.
            const double rate = before < model::never ? change / before : 1;
            const double rounding = std::max(16 * epsilon * scale, rounding_of_motion(0));
            bool converged = change <= rounding || change * rate <= 0.01 * tolerance_ * scale;
            if (!converged && i >= 2 && change > 0.5 * before) {
                if (change > rounding_left_by_iteration * rounding) break;
                converged = true;  // it does not get better than that
            }
            if (converged) {
                take_M(torque);
                return Iteration::converged;
            }
        }
        if (!again) estimate_slopes();
    }
    kappa_ = chi_ = 0;  // a shorter panel begins without them: they may be what is wrong
    return Iteration::diverges;
}

/// Whether a panel's equation can be solved with the slopes of the feedback in it. Negative ones make the motion grow
/// from one end of the panel to the other: more than a little is none that a polynomial follows.
bool SpectralEngine::well_conditioned() const {
    constexpr double most = 4;
    const double a = panel_.h * ((system_.damping() + chi_) / system_.inertia());
    const double b = panel_.h * (panel_.h * ((system_.stiffness() + kappa_) / system_.inertia()));
    return a >= -most && std::fabs(b) <= most;
}

/// M as it acts on the motion just found: what was iterated and the linear part, which was solved for, but for what
/// of them is friction.
void SpectralEngine::take_M(const Series& iterated) {
    for (std::size_t k = 0; k < points; ++k) panel_.M[k] = iterated[k] - kappa_ * p_[k] - chi_ * (v_[k] / panel_.h);
    if (!system_.has_remainder()) return;
    const auto p = chebyshev::at_nodes(p_), v = chebyshev::at_nodes(v_);
    chebyshev::Samples friction{};
    for (std::size_t j = 0; j < points; ++j) friction[j] = remainder({y_.theta + p[j], v[j] / panel_.h});
    const Series series = chebyshev::fit(friction);
    for (std::size_t k = 0; k < points; ++k) panel_.M[k] += series[k];
}

/// How M depends on theta and velocity, by secants as wide as the motion on this panel: that of the last iteration, but
/// no wider than the torques at its beginning can make it.
void SpectralEngine::estimate_slopes() {
    const double t = clock_.hi, h = panel_.h;
    const double torque =
        std::fabs(samples_[0]) + system_.stiffness() * std::fabs(y_.theta) + std::fabs(system_.braking(panel_.motion));
    const double fastest = std::fabs(y_.velocity) + h * torque / system_.inertia();
    const double d_theta = std::max(std::min(chebyshev::size(p_), 2 * h * fastest), 1e-6 * std::fabs(y_.theta));
    const double d_velocity = std::max(std::min(chebyshev::size(v_) / h, fastest), 1e-6 * std::fabs(y_.velocity));
    const auto slope = [](double above, double below, double d) {
        const double s = d > 0 && d < model::never ? (below - above) / (2 * d) : 0;
        return std::isfinite(s) ? s : 0;
    };
    const auto torque_at = [&](const model::State& state) { return excitation_.value(t, state) - remainder(state); };
    kappa_ = slope(torque_at({y_.theta + d_theta, y_.velocity}), torque_at({y_.theta - d_theta, y_.velocity}), d_theta);
    chi_ = slope(torque_at({y_.theta, y_.velocity + d_velocity}), torque_at({y_.theta, y_.velocity - d_velocity}),
                 d_velocity);
}

}  // namespace dinal::motion::spectral
