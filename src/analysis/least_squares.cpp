#include "analysis/least_squares.hpp"

#include <algorithm>
#include <cmath>

#include "algebra/decompositions.hpp"

namespace dinal::analysis {
namespace {

double size_of(const Eigen::VectorXd& p, const FitScale& scale, Eigen::Index i) {
    return std::max(std::fabs(p[i]), scale.typical[i]);
}

/// Forward differences, one run for each parameter: accurate enough for the descent. They never cross a lower bound.
std::optional<Eigen::MatrixXd> slopes(const Prediction& model, const Eigen::VectorXd& p, const FitScale& scale,
                                      const Eigen::VectorXd& here) {
    Eigen::MatrixXd J(here.size(), p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) {
        Eigen::VectorXd up = p;
        up[i] += 1e-7 * size_of(p, scale, i);
        const auto above = model(up);
        if (!above) return {};
        J.col(i) = (*above - here) / (up[i] - p[i]);
    }
    return J;
}

}  // namespace

std::optional<Eigen::MatrixXd> derivative(const Prediction& model, const Eigen::VectorXd& p, const FitScale& scale,
                                          double noise) {
    const auto here = model(p);
    if (!here) return {};
    const auto slope = [&](Eigen::Index i, double step) -> std::optional<Eigen::VectorXd> {
        Eigen::VectorXd other = p;
        other[i] = std::max(p[i] + step, scale.least[i]);
        if (other[i] == p[i]) return {};
        const auto there = model(other);
        if (!there) return {};
        return (*there - *here) / (other[i] - p[i]);
    };
    // A one-sided difference by a step that changes the prediction by about the noise. The step is bracketed between h
    // and too_long.
    const auto secant = [&](Eigen::Index i, double side) {
        double h = 1e-6 * size_of(p, scale, i), too_long = INFINITY;
        auto found = slope(i, side * h);
        constexpr int most_tries = 12;
        for (int tries = 0; tries < most_tries && found; ++tries) {
            const double change = h * found->norm();
            if (change > noise / 2) return found;
            const double next = std::isfinite(too_long)
                                    ? std::sqrt(h * too_long)
                                    : std::min(h * std::min(noise / std::max(change, 1e-300), 1e3), scale.whole[i]);
            if (!(next > 1.05 * h)) break;
            auto further = slope(i, side * next);
            if (!further || next * further->norm() > 2 * noise) {
                too_long = next;
            } else {
                h = next;
                found = std::move(further);
            }
        }
        // A jump lies within reach: count its effect only up to the size of the noise.
        const auto beyond = found && std::isfinite(too_long) ? slope(i, side * too_long) : std::nullopt;
        if (beyond) found = *beyond * std::min(1.0, noise / (too_long * beyond->norm()));
        return found;
    };
    Eigen::MatrixXd J(here->size(), p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) {
        const auto up = secant(i, 1), down = secant(i, -1);
        if (!up && !down) return {};
        constexpr double jump = 3;  // a greater ratio is a jump, not a bend
        const double above = up ? up->norm() : INFINITY, below = down ? down->norm() : INFINITY;
        if (above > jump * below) {
            J.col(i) = *down;
        } else if (below > jump * above) {
            J.col(i) = *up;
        } else {
            J.col(i) = (*up + *down) / 2;
        }
    }
    return J;
}

std::optional<LeastSquares> least_squares(const Prediction& model, const Eigen::VectorXd& measured,
                                          const Eigen::VectorXd& start, const FitScale& scale, int most_steps) {
    LeastSquares now{start.cwiseMax(scale.least), {}, 0};
    const auto first = model(now.parameters);
    if (!first) return {};
    now.residual = measured - *first;
    now.sum = now.residual.squaredNorm();
    if (!std::isfinite(now.sum)) return {};
    if (start.size() == 0) return now;
    const Eigen::VectorXd& hold = scale.hold;
    const auto held = [&](const Eigen::VectorXd& p) { return (p - start).cwiseProduct(hold).squaredNorm(); };
    double damping = 1e-3;
    for (int step = 0; step < most_steps; ++step) {
        auto J = slopes(model, now.parameters, scale, measured - now.residual);
        if (!J) return {};
        Eigen::VectorXd size(start.size());
        for (Eigen::Index i = 0; i < size.size(); ++i) J->col(i) *= size[i] = size_of(now.parameters, scale, i);
        Eigen::MatrixXd normal = J->transpose() * *J;
        Eigen::VectorXd gradient = J->transpose() * now.residual;
        const double most = std::max(normal.diagonal().maxCoeff(), 1e-300);
        normal.diagonal() += size.cwiseProduct(hold).cwiseAbs2();
        gradient -= (now.parameters - start).cwiseProduct(hold.cwiseAbs2()).cwiseProduct(size);
        for (Eigen::Index i = 0; i < size.size(); ++i) {
            // A parameter that would cross its bound stays there; one without influence stays in place.
            const bool at_bound = now.parameters[i] <= scale.least[i] && gradient[i] < 0;
            if (!at_bound && normal(i, i) > 1e-10 * most) continue;
            normal.row(i).setZero();
            normal.col(i).setZero();
            normal(i, i) = most;
            gradient[i] = 0;
        }
        const double before = now.sum;
        double moved = 0;
        bool better = false;
        damping /= 4;
        for (int tries = 0; tries < 12 && !better; ++tries) {
            damping *= 4;
            Eigen::MatrixXd damped = normal;
            damped.diagonal() *= 1 + damping;
            const Eigen::VectorXd way = algebra::solve_symmetric(damped, gradient).cwiseProduct(size);
            Eigen::VectorXd next = (now.parameters + way).cwiseMax(scale.least);
            for (Eigen::Index i = 0; i < next.size(); ++i) {
                // A positive parameter shrinks at most by a factor 4 per step: after a long step to 0 it would not
                // return.
                if (scale.least[i] > 0) next[i] = std::max(next[i], now.parameters[i] / 4);
            }
            if (!next.allFinite()) continue;
            const auto predicted = model(next);
            if (!predicted) continue;
            const Eigen::VectorXd residual = measured - *predicted;
            if (!(residual.squaredNorm() + held(next) < now.sum + held(now.parameters))) continue;
            better = true;
            for (Eigen::Index i = 0; i < next.size(); ++i) {
                moved = std::max(moved, std::fabs(next[i] - now.parameters[i]) / size_of(next, scale, i));
            }
            now.parameters = next;
            now.residual = residual;
            now.sum = residual.squaredNorm();
            damping = std::max(damping / 6, 1e-12);
        }
        if (!better || moved < 1e-10 || before - now.sum < 1e-7 * before) break;
    }
    return now;
}

Covariance covariance_of(Eigen::MatrixXd J, const Eigen::VectorXd& whole, double noise) {
    const Eigen::Index rows = J.rows(), n = J.cols();
    const std::vector<bool> none(static_cast<std::size_t>(n), false);
    Covariance result{Eigen::MatrixXd::Zero(n, n), none, none};
    if (n == 0) return result;
    // Derivatives below 1e-8 of the greatest are rounding of the differences.
    constexpr double widest = widest_error, rounding = 1e-8;
    J *= whole.asDiagonal();
    const double known = std::max(noise / widest, rounding * std::max(J.colwise().norm().maxCoeff(), 1e-300));
    J.conservativeResize(rows + n, n);
    J.bottomRows(n) = Eigen::MatrixXd::Identity(n, n) * known;
    const Eigen::MatrixXd R = algebra::triangular_factor(J);
    const Eigen::MatrixXd inverse = algebra::inverse_of_triangular(R);
    result.matrix = inverse * inverse.transpose();
    for (Eigen::Index i = 0; i < n; ++i) {
        const double unknown = known * std::sqrt(result.matrix(i, i));  // 1 if nothing depends on the parameter
        result.silent[static_cast<std::size_t>(i)] = unknown > 1 / widest;
        constexpr double most = 0.5;
        result.open[static_cast<std::size_t>(i)] = unknown > most;
        result.log_volume -= std::log(std::fabs(R(i, i)));
    }
    result.matrix = whole.asDiagonal() * result.matrix * whole.asDiagonal();
    return result;
}

double correlation_length(std::span<const double> residual) {
    const std::size_t n = residual.size();
    double square = 0;
    for (const double x : residual) square += x * x;
    if (!(square > 0)) return 1;
    const double noise = 2 / std::sqrt(static_cast<double>(n));
    double length = 1;
    for (std::size_t lag = 1; lag < n / 4; ++lag) {
        double sum = 0;
        for (std::size_t i = 0; i + lag < n; ++i) sum += residual[i] * residual[i + lag];
        if (sum / square < noise) break;
        length += 2 * sum / square;
    }
    return length;
}

}  // namespace dinal::analysis
