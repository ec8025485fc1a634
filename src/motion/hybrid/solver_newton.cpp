// Collocation: the values at the nodes of a piece by Newton's steps.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/hybrid/integration.hpp"
#include "motion/hybrid/solver.hpp"

namespace dinal::motion::hybrid {

namespace {

constexpr int most_iterations = 40;
constexpr int many_iterations = 4;       // slopes that need so many no longer serve, and are asked anew
constexpr double most_left_over = 1e-6;  // of the equation; a stiff rate multiplies the rounding of its steps

using NodeVector = Eigen::Matrix<double, node_count, 1>;
}  // namespace

/// How the rates depend on the values, by differences at a node, narrow against the motion there.
bool Solver::estimate_jacobian(const Solved& piece, std::size_t node) {
    Linear& linear = moves(piece) ? moving_ : standing_;
    linear.jacobian.setZero(static_cast<Eigen::Index>(n_), static_cast<Eigen::Index>(n_));
    for (Linear::Matrix& matrix : linear.of_lengths) matrix.h = 0;
    if (linear_ && moves(piece)) {
        linear.known = true;
        linear.jacobian(1, 0) = -system_.stiffness() / system_.inertia();
        linear.jacobian(1, 1) = -system_.damping() / system_.inertia();
        return true;
    }
    Values &y = point_, &above = rate_, &below = other_rate_;
    for (std::size_t k = 0; k < n_; ++k) y[k] = piece.y[k][node];
    const auto rates = [&](double* out) {
        double M = 0;
        return rates_of(piece, piece.times[node], piece.side(node), {y[0], y[1]}, y, piece.belt_rate[node], out, M,
                        piece.push[node], piece.belt[node]);
    };
    for (std::size_t l = moves(piece) ? 0 : 2; l < n_; ++l) {
        const double spread = std::fabs(piece.y[l][node]) + piece.h * std::fabs(piece.f[l][node]);
        const double d = spread > 0 ? 1e-4 * spread : 1e-9;
        y[l] = piece.y[l][node] + d;
        if (!rates(above.data())) return false;
        y[l] = piece.y[l][node] - d;
        if (!rates(below.data())) return false;
        y[l] = piece.y[l][node];
        for (std::size_t k = 0; k < n_; ++k) {
            linear.jacobian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) =
                (above[k] - below[k]) / (2 * d);
        }
    }
    linear.known = true;
    return true;
}

/// The matrix of Newton's steps: 1 - h J times the integration, where theta is the integral of the velocity.
Solver::Linear::Matrix& Solver::newton_matrix(const Solved& piece) {
    Linear& linear = moves(piece) ? moving_ : standing_;
    for (Linear::Matrix& matrix : linear.of_lengths) {
        if (std::fabs(matrix.h / piece.h - 1) < 1e-6) return matrix;
    }
    const auto size = static_cast<Eigen::Index>(inner), first = static_cast<Eigen::Index>(first_unknown(piece));
    const auto n = static_cast<Eigen::Index>(n_);
    using Inner = Eigen::Matrix<double, inner, inner>;
    static const Inner once = integration().bottomRightCorner<inner, inner>(), twice = once * once;
    Eigen::MatrixXd A = Eigen::MatrixXd::Identity(size * (n - first), size * (n - first));
    for (Eigen::Index k = first; k < n; ++k) {
        for (Eigen::Index l = first; l < n; ++l) {
            const double slope = piece.h * linear.jacobian(k, l);
            if (slope != 0) A.block<inner, inner>((k - first) * size, (l - first) * size) -= slope * once;
        }
        const double stiffness = piece.h * piece.h * linear.jacobian(k, 0);
        if (moves(piece) && stiffness != 0) A.block<inner, inner>((k - first) * size, 0) -= stiffness * twice;
    }
    Linear::Matrix& matrix = linear.of_lengths[linear.next];
    linear.next = (linear.next + 1) % linear.of_lengths.size();
    matrix.factors.compute(A);
    matrix.inverse.resize(0, 0);
    matrix.h = piece.h, matrix.steps = 0;
    return matrix;
}

void Solver::take_newton_step(const Solved& piece) {
    constexpr int worth_an_inverse = 32;
    Linear::Matrix& matrix = newton_matrix(piece);
    if (++matrix.steps == worth_an_inverse) matrix.inverse = matrix.factors.inverse();
    if (matrix.inverse.size() == 0) {
        step_ = matrix.factors.solve(residual_);
    } else {
        step_.noalias() = matrix.inverse * residual_;
    }
}

/// Theta at the nodes, by the velocities there.
void Solver::place(Solved& piece) const {
    const Eigen::Map<const NodeVector> velocity(piece.y[1].data());
    Eigen::Map<NodeVector> theta(piece.y[0].data());
    theta = (piece.y[0][0] + piece.h * (integration() * velocity).array()).matrix();
}

Solver::Attempt Solver::collocate(Solved& piece, const model::State& departing) {
    Linear& linear = moves(piece) ? moving_ : standing_;
    unresolved_ = std::numeric_limits<double>::infinity();
    const std::size_t first = first_unknown(piece);
    residual_.resize(static_cast<Eigen::Index>(inner * (n_ - first)));
    step_.resize(residual_.size());
    // Beside a jump of a rate differences tell a slope that is none; where a piece is short it does without any.
    enum class Slopes { known, here, none };
    for (const Slopes slopes : {Slopes::known, Slopes::here, Slopes::none}) {
        const bool sloped = slopes != Slopes::none;
        if (!evaluate(piece, 0, departing)) return Attempt::failed;
        if (!moves(piece)) {
            for (std::size_t j = 1; j < node_count; ++j) piece.y[1][j] = piece.carrier(j);
        }
        for (std::size_t k = first; k < n_; ++k) {
            for (std::size_t j = 1; j < node_count; ++j) {
                piece.y[k][j] = piece.y[k][0] + piece.h * (1 + cheb::nodes[j]) * piece.f[k][0];
            }
        }
        if (moves(piece) || (field_.has_belt() && !piece.leans)) place(piece);
        double before = std::numeric_limits<double>::infinity();
        for (int i = 0; i < most_iterations; ++i) {
            for (std::size_t j = 1; j < node_count; ++j) {
                if (!evaluate(piece, j, {piece.y[0][j], piece.y[1][j]})) return Attempt::failed;
            }
            if (first == n_) return Attempt::resolved;
            if (sloped && !linear.known && !estimate_jacobian(piece, node_count / 2)) return Attempt::failed;
            for (std::size_t k = first; k < n_; ++k) {
                const Eigen::Map<const NodeVector> f(piece.f[k].data()), y(piece.y[k].data());
                residual_.segment<inner>(static_cast<Eigen::Index>((k - first) * inner)) =
                    (y[0] - y.tail<inner>().array()).matrix() + piece.h * (integration().bottomRows<inner>() * f);
            }
            if (sloped) {
                take_newton_step(piece);
            } else {
                step_ = residual_;
            }
            double change = 0, left = 0;
            const double gained = piece.h / system_.inertia() * torques_of(piece, greatest(piece.M));
            for (std::size_t k = first; k < n_; ++k) {
                const auto row = static_cast<Eigen::Index>((k - first) * inner);
                Eigen::Map<NodeVector>(piece.y[k].data()).tail<inner>() += step_.segment<inner>(row);
                // Torques that balance leave a velocity that is the rounding of each of them, however small it is.
                const double scale =
                    greatest(piece.y[k]) + (k == 1 ? gained : 0) + std::numeric_limits<double>::min() / rounding;
                change = std::max(change, step_.segment<inner>(row).lpNorm<Eigen::Infinity>() / scale);
                left = std::max(left, residual_.segment<inner>(row).lpNorm<Eigen::Infinity>() / scale);
            }
            if (moves(piece)) place(piece);
            if (!std::isfinite(change + left)) break;
            const double rate = before < std::numeric_limits<double>::infinity() ? change / before : 1;
            const bool converged = change <= 16 * rounding || (i >= 1 && change * rate <= 4 * rounding) ||
                                   (i >= 2 && change <= 1e-12 && rate > 0.3);
            // With slopes that are far off no step goes anywhere, and the equation does not hold.
            if (converged && left <= most_left_over) {
                if (i >= many_iterations) linear.known = false;
                return Attempt::resolved;
            }
            if (i >= 3 && rate > 0.7) break;
            before = change;
        }
        if (slopes == Slopes::known && !estimate_jacobian(piece, 0)) break;  // the others may be anywhere by now
    }
    linear.known = false;
    return Attempt::shorten;
}

}  // namespace dinal::motion::hybrid
