#include "motion/engine/runge_kutta.hpp"

#include <algorithm>
#include <cmath>

#include "motion/engine/noise.hpp"
#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

/// Makes one step of the groups and states. Dense output: for rk4 the quintic through angles, velocities and
/// accelerations at both ends, and cubics through values and rates for states; for a pair, cubics plus its bulge.
Flow::Attempt RungeKutta::find(Segment& s, const Mode& mode, const Frame& frame, const std::vector<double>& departing) {
    constexpr std::size_t middle = node_count / 2, last = node_count - 1;
    const double h = 2 * s.h;
    const std::size_t groups = frame.groups(), size = 2 * groups + m_;
    unknown_.resize(groups + m_), found_.resize(groups + m_);
    std::vector<double> speeds(groups, 0);  // velocities of the groups at the start
    for (std::size_t i = 0; i < n_; ++i) {
        const double v = s.y[n_ + i][0] - offsets_.velocities[i][0],
                     momentum = mechanics_.system().bodies[i].inertia * v;
        for (const auto& [group, by] : frame.bodies[i]) speeds[group] += by * momentum / frame.inertia[group];
    }
    for (std::size_t i = 0; i < n_; ++i) {
        const Frame::Shape& shape = frame.bodies[i];
        if (shape.size() == 1) speeds[shape[0].group] = (s.y[n_ + i][0] - offsets_.velocities[i][0]) / shape[0].by;
    }
    /// Stores changes at a node: displacements and velocity changes of the groups, and changes of the states.
    const auto put = [&](std::size_t node, const std::vector<double>& change) {
        for (std::size_t i = 0; i < n_; ++i) {
            const Frame::Shape& shape = frame.bodies[i];
            const double first = shape.empty() ? 0 : s.y[n_ + i][0] - offsets_.velocities[i][0];
            s.moved[i][node] = offsets_.ways[i][node] + sum_of_groups(shape, [&](std::size_t g) { return change[g]; });
            s.y[i][node] = s.y[i][0] + s.moved[i][node];
            if (node == 0) continue;
            s.y[n_ + i][node] = offsets_.velocities[i][node] +
                                (first + sum_of_groups(shape, [&](std::size_t g) { return change[groups + g]; }));
        }
        for (std::size_t k = 0; k < m_; ++k) s.y[2 * n_ + k][node] = s.y[2 * n_ + k][0] + change[2 * groups + k];
    };
    const auto rates = [&](std::size_t node, const std::vector<double>& change, std::vector<double>& out) {
        put(node, change);
        if (!evaluate(s, mode, frame, node, node + 1, node == 0 ? &departing : nullptr)) return false;
        out.resize(size);
        for (std::size_t g = 0; g < groups; ++g) out[g] = speeds[g] + change[groups + g];
        for (std::size_t k = 0; k < groups + m_; ++k) out[groups + k] = found_[k][node];
        return true;
    };
    const auto along = [&](double length, const std::vector<double>& slope) {
        std::vector<double> change(size);
        for (std::size_t k = 0; k < size; ++k) change[k] = length * slope[k];
        return change;
    };
    std::vector<double> a, b, c, d, e, z(size, 0);
    if (pair_ != nullptr) {
        if (!find_stages(s, rates, z)) return Attempt::failed;
        a = last_.stages.front(), e = last_.stages.back();
    } else {
        if (!rates(0, z, a) || !rates(middle, along(h / 2, a), b) || !rates(middle, along(h / 2, b), c) ||
            !rates(last, along(h, c), d)) {
            return Attempt::failed;
        }
        for (std::size_t k = 0; k < size; ++k) z[k] = h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
        if (!rates(last, z, e)) return Attempt::failed;
    }
    // In a tiny part of a step angles differ only by rounding, which is too little to determine velocities.
    const bool quintic = h >= 1e-3 * step_ && pair_ == nullptr;
    const auto cubic = [&](std::size_t k, double x) {
        const double v0 = h * a[k], v1 = h * e[k];
        return x * (v0 + x * ((3 * z[k] - 2 * v0 - v1) + x * (v0 + v1 - 2 * z[k])));
    };
    std::vector<double> change(size);
    std::vector<StepInterpolant> motions;
    for (std::size_t g = 0; g < groups && quintic; ++g) {
        const std::size_t v = groups + g;
        motions.emplace_back(h, model::State{0, a[g]}, a[v], model::State{z[g], e[g]}, e[v]);
    }
    for (std::size_t j = 1; j < last; ++j) {
        const double x = (1 + cheb::nodes[j]) / 2;
        for (std::size_t k = 0; k < size; ++k) change[k] = cubic(k, x);
        for (std::size_t k = 0; k < size && pair_ != nullptr; ++k)
            change[k] += x * x * (1 - x) * (1 - x) * last_.bulge[k];
        for (std::size_t g = 0; g < groups && quintic; ++g) {
            const model::State between = motions[g](x * h);
            change[g] = between.theta, change[groups + g] = between.velocity - a[g];
        }
        put(j, change);
    }
    if (!evaluate(s, mode, frame, 1, last, nullptr)) return Attempt::failed;
    unknown_ = found_;
    return Attempt::resolved;
}

Flow::Attempt RungeKutta::accept(Segment& s, const Mode& mode, const Frame& frame) {
    const double error = pair_ != nullptr ? error_of_step(s, frame) : 0;
    judge(s, mode, frame);
    s.proven = pair_ != nullptr || !mechanics_.has_functions();
    if (pair_ == nullptr) return Attempt::resolved;
    unresolved_ = std::max(unresolved_, std::pow(error, cheb::degree / pair_->power));
    growth_ = std::min(growth_, std::pow(error, -1 / pair_->power));
    return look_between(s, mode, frame);
}

/// Computes the stages of the pair. Stages between nodes temporarily use the first inner nodes, with time-only
/// functions evaluated by the polynomial through their samples. The stretch counts as resolved only if this polynomial
/// is.
template <class Rates>
bool RungeKutta::find_stages(Segment& s, const Rates& rates, std::vector<double>& change) {
    const std::span<const Pair::Stage> stages = pair_->stages;
    std::vector<std::pair<Nodes*, Nodes>> lent;
    const auto lend = [&](Nodes& values) {
        const Series series = cheb::fit(lent.emplace_back(&values, values).second);
        for (std::size_t i = 0; i < stages.size(); ++i) {
            if (stages[i].at < 1) values[i + 1] = cheb::value(series, 2 * stages[i].at - 1);
        }
    };
    lend(s.times);
    for (auto* all : {&s.loads, &s.belts, &offsets_.velocities, &offsets_.rates, &offsets_.ways}) {
        std::for_each(all->begin(), all->end(), lend);
        if (!mechanics_.has_belts()) break;  // without belts the rest is zero
    }
    const auto sum_of_stages = [&](const Pair::Weights& weights, std::vector<double>& sum) {
        sum.assign(change.size(), 0);
        for (std::size_t i = 0; i < last_.stages.size(); ++i) {
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += 2 * s.h * weights[i] * last_.stages[i][k];
        }
    };
    last_.stages.resize(1);
    bool good = rates(0, change, last_.stages[0]);
    for (std::size_t i = 0; i < stages.size() && good; ++i) {
        sum_of_stages(stages[i].sum, change);
        last_.stages.emplace_back();
        good = rates(stages[i].at < 1 ? i + 1 : node_count - 1, change, last_.stages.back());
    }
    for (auto& [values, kept] : lent) *values = kept;
    if (good) sum_of_stages(pair_->error, last_.error), sum_of_stages(pair_->bulge, last_.bulge);
    return good;
}

/// Returns the estimated error of the pair's last step relative to the allowed one. A step that is far too long may
/// reach huge torques, so it is compared with the torques at its start. The error includes noise, which a shorter step
/// would not reduce.
double RungeKutta::error_of_step(const Segment& s, const Frame& frame) const {
    // fraction of the longest stretch: weighs the error of an angle against that of a velocity
    constexpr double of_longest = 4;
    const std::size_t groups = frame.groups();
    double most = 0;
    const auto note = [&](double error, std::size_t k, double acts) {
        const double size = std::max(greatest(s.y[k]), s.h * std::fabs(s.f[k][0])), all = size + acts;
        const double rough = std::min(of_tail * s.h * cheb::tail(s.rates[k]), most_noise * all);
        most = std::max(most, error / (tolerance_ * size + 64 * rounding * all + rough + smallest / s.h));
    };
    for (std::size_t i = 0; i < n_; ++i) {
        double way = 0, velocity = 0, per_torque = 0;
        for (const auto& [group, by] : frame.bodies[i]) {
            way += by * last_.error[group], velocity += by * last_.error[groups + group];
            per_torque += s.h * by * by / frame.inertia[group];
        }
        note(std::max(std::fabs(velocity), of_longest / longest_ * std::fabs(way)), n_ + i,
             per_torque * sizes_.at_start.on_body(i));
    }
    for (std::size_t k = 0; k < m_; ++k)
        note(std::fabs(last_.error[2 * groups + k]), 2 * n_ + k, s.h * fastest_.rates[k]);
    return most;
}

}  // namespace dinal::motion::engine
