#include "analysis/steady_facts.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "model/lowered.hpp"

namespace dinal::analysis {
namespace {

using model::Motion;

/// Friction is the same both ways.
bool acts_evenly(const model::Friction& law, const model::Lowered& system) {
    for (const double speed : {1e-3, 0.1, 1.0, 10.0}) {
        if (law.sliding(Motion::forward, speed) != law.sliding(Motion::backward, speed)) return false;
    }
    return system.braking(Motion::forward) == -system.braking(Motion::backward) &&
           system.holding(Motion::forward) == system.holding(Motion::backward);
}

}  // namespace

bool contracts(const SteadyQuestion& question) {
    const model::Lowered system(question.system);
    return !system.has_remainder() && !question.excitation.has_feedback() && !question.system.walls() &&
           system.holding(Motion::forward) == system.braking(Motion::forward) &&
           system.holding(Motion::backward) == -system.braking(Motion::backward);
}

bool is_alike_both_ways(const SteadyQuestion& question) {
    const model::Oscillator& system = question.system;
    return acts_evenly(system.friction(), system) && system.spring().is_odd() &&
           (!system.walls() || system.walls()->alike()) && is_antisymmetric(question.excitation, question.drive);
}

SteadyMotion facts_of(const SteadyQuestion& question, const PeriodMap& map, const FixedPointSearch::Try& found,
                      int periods, bool half) {
    const MapStep& step = found.step;
    SteadyMotion motion;
    motion.status = step.moved ? SteadyStatus::steady : SteadyStatus::adheres;
    motion.outcome = step.outcome;
    motion.periods = periods;
    motion.period = half ? 2 * map.length() : map.length();
    motion.start = map.state(found.x);
    motion.low = step.low;
    motion.high = step.high;
    motion.t_high = step.t_high;
    if (half) {
        motion.low = std::min(step.low, -step.high);
        motion.high = -motion.low;
        if (-step.low > step.high) motion.t_high = step.t_low + map.length();
    }
    motion.amplitude = (motion.high - motion.low) / 2;
    motion.stops = half ? 2 * step.stops : step.stops;
    motion.stuck = step.moved ? std::min(1.0, step.stuck / map.length()) : 1;
    motion.residual = found.residual() / found.size;
    motion.differentiable = step.differentiable;
    const Eigen::Vector2cd values = Eigen::EigenSolver<Eigen::Matrix2d>(step.derivative, false).eigenvalues();
    motion.multipliers = {values[0], values[1]};
    if (half) motion.multipliers = {values[0] * values[0], values[1] * values[1]};
    const bool contracting = contracts(question);
    const double slack = contracting ? neutral_within : 1e-5;
    const auto& m = motion.multipliers;
    motion.stable = !step.moved || (step.differentiable && std::max(std::abs(m[0]), std::abs(m[1])) <= 1 + slack);
    if (contracting && step.moved && step.differentiable) {
        motion.unique = std::min(std::abs(m[0] - 1.0), std::abs(m[1] - 1.0)) > neutral_within;
    }
    motion.symmetric = half;
    return motion;
}

}  // namespace dinal::analysis
