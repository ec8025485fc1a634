#include "analysis/fixed_point.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/decompositions.hpp"

namespace dinal::analysis {
namespace {

constexpr double closed = 1e-12;  // residual of a fixed point relative to the motion
constexpr double as_closed_as_can_be = 2e-15;
constexpr double as_near_as_need_be = 1e-14;  // relative to the motion: smaller steps are not worth a period
constexpr double nearly_closed = 1e-9;        // accepted residual if rounding prevents a smaller one

}  // namespace

FixedPointSearch::Try FixedPointSearch::at(const Place& x, double size) const {
    Try result;
    result.x = x;
    result.step = map_.with_derivative(x, std::max(size, length_of(x)));
    maps_ += result.step.differentiable ? 1 : 5;
    result.off = sign_ * result.step.to - x;
    result.size = std::max({length_of(x), length_of(result.step.to), result.step.high - result.step.low, 1e-300});
    result.rounding = map_.rounding();
    return result;
}

std::optional<FixedPointSearch::Try> FixedPointSearch::confirmed(const Place& from) const {
    const Try now = at(from, 0);
    if (!now.at(1e-6)) return {};
    const Try found = polished(now);
    return found.at(closed) ? std::optional(found) : std::nullopt;
}

std::optional<FixedPointSearch::Try> FixedPointSearch::search(const Place& from, int most) const {
    Try now = at(from, 0);
    for (int i = 0; i < most && now.step.finished; ++i) {
        if (now.at(closed)) return polished(now);
        const std::optional<Try> next = newton(now);
        now = next ? *next : at(sign_ * now.step.to, now.size);
    }
    return now.at(nearly_closed) ? std::optional(polished(now)) : std::nullopt;
}

Place FixedPointSearch::step(const Try& now) const {
    const Eigen::Matrix2d matrix = Eigen::Matrix2d::Identity() - sign_ * now.step.derivative;
    const double determinant = matrix(0, 0) * matrix(1, 1) - matrix(0, 1) * matrix(1, 0);
    if (std::fabs(determinant) > 1e-6 * matrix.squaredNorm()) {
        return Place(matrix(1, 1) * now.off[0] - matrix(0, 1) * now.off[1],
                     matrix(0, 0) * now.off[1] - matrix(1, 0) * now.off[0]) /
               determinant;
    }
    return algebra::solve_by_singular_values(matrix, now.off, 1e-9);
}

std::optional<FixedPointSearch::Try> FixedPointSearch::newton(const Try& now) const {
    if (!now.step.differentiable) return {};
    const Place whole = step(now);
    for (const double part : {1.0, 0.25, 0.0625}) {
        Try next = at(now.x + part * whole, now.size);
        if (next.step.finished && next.residual() <= (1 - part / 2) * now.residual()) return next;
    }
    return {};
}

FixedPointSearch::Try FixedPointSearch::polished(Try now) const {
    for (int i = 0; i < 2 && now.step.differentiable && now.residual() > as_closed_as_can_be * now.size; ++i) {
        const Place whole = step(now);
        if (length_of(whole) <= as_near_as_need_be * now.size) break;
        Try next = at(now.x + whole, now.size);
        if (!next.step.finished || !(next.residual() < now.residual() / 2)) break;
        now = next;
    }
    return now;
}

}  // namespace dinal::analysis
