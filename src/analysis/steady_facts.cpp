#include "analysis/steady_facts.hpp"

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

std::array<std::complex<double>, 2> eigenvalues(const Eigen::Matrix2d& D) {
    const double mean = (D(0, 0) + D(1, 1)) / 2, half = (D(0, 0) - D(1, 1)) / 2;
    const double square = half * half + D(0, 1) * D(1, 0);
    if (square < 0) {
        const double turn = std::sqrt(-square);
        return {std::complex(mean, turn), std::complex(mean, -turn)};
    }
    // The greater one first: the other is a quotient, and no difference.
    const double first = mean + std::copysign(std::sqrt(square), mean);
    const double determinant = D(0, 0) * D(1, 1) - D(0, 1) * D(1, 0);
    return {std::complex(first), std::complex(first == 0 ? 0 : determinant / first)};
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
    motion.amplitude = (motion.high - motion.low) / 2 + 0.0;  // no -0 of a mass that stands at -0
    motion.stops = half ? 2 * step.stops : step.stops;
    motion.stuck = step.moved ? std::min(1.0, step.stuck / map.length()) : 1;
    motion.residual = found.residual() / found.size;
    motion.differentiable = step.differentiable;
    motion.multipliers = eigenvalues(step.derivative);
    if (half) {
        for (std::complex<double>& value : motion.multipliers) value *= value;
    }
    const bool contracting = contracts(question);
    const double slack = contracting ? neutral_within : 1e-5;
    const auto& m = motion.multipliers;
    motion.stable = !step.moved || (step.differentiable && std::max(std::abs(m[0]), std::abs(m[1])) <= 1 + slack);
    if (contracting && step.moved && step.differentiable && !step.on_edge) {
        motion.unique = std::min(std::abs(m[0] - 1.0), std::abs(m[1] - 1.0)) > neutral_within;
    }
    motion.symmetric = half;
    return motion;
}

}  // namespace dinal::analysis
