#include <algorithm>

#include "motion/hybrid/solver.hpp"
#include "motion/interpolation.hpp"

namespace dinal::motion::hybrid {

/// One classical step; between its ends theta is the quintic, the others are cubics through values and rates.
Solver::Attempt Solver::runge_kutta(Solved& piece, const model::State& departing) {
    const double h = 2 * piece.h;
    Values y(n_), a(n_), b(n_), c(n_), d(n_), e(n_), z(n_);
    for (std::size_t k = 0; k < n_; ++k) y[k] = piece.y[k][0];
    double M = 0;
    const auto rates = [&](double part, const Values& values, double* out, const model::State* asked) {
        const double t = part == 1 ? piece.end : piece.start.after(part * h);
        const Side side = part == 0 ? piece.side(0) : part == 1 ? piece.side(node_count - 1) : Side::at;
        const std::size_t node = part == 0 ? 0 : part == 1 ? node_count - 1 : node_count / 2;
        const model::State own{values[0], values[1]};
        return rates_of(piece, t, side, asked != nullptr ? *asked : own, values, piece.belt_rate[node], out, M,
                        piece.push[node], piece.belt[node]);
    };
    const auto along = [&](double length, const Values& slope) {
        for (std::size_t k = 0; k < n_; ++k) z[k] = y[k] + length * slope[k];
    };
    bad_time_ = piece.end;
    if (!rates(0, y, a.data(), &departing)) return Attempt::failed;
    along(h / 2, a);
    if (!rates(0.5, z, b.data(), nullptr)) return Attempt::failed;
    along(h / 2, b);
    if (!rates(0.5, z, c.data(), nullptr)) return Attempt::failed;
    along(h, c);
    if (!rates(1, z, d.data(), nullptr)) return Attempt::failed;
    for (std::size_t k = 0; k < n_; ++k) z[k] = y[k] + h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    if (!moves(piece)) z[1] = piece.carrier(node_count - 1);
    if (!rates(1, z, e.data(), nullptr)) return Attempt::failed;
    const StepInterpolant motion(h, {y[0], y[1]}, a[1], {z[0], z[1]}, e[1]);
    // In a small part of a step the places differ by rounding, of which no velocity can be made.
    const bool small = h < 1e-3 * cut_.h;
    for (std::size_t j = 0; j < node_count; ++j) {
        const double x = piece.h * (1 + cheb::nodes[j]), s = x / h;
        const auto cubic = [&](std::size_t k) {
            const double p = z[k] - y[k], v0 = h * a[k], v1 = h * e[k];
            return y[k] + s * (v0 + s * ((3 * p - 2 * v0 - v1) + s * (v0 + v1 - 2 * p)));
        };
        const model::State state = small ? model::State{cubic(0), cubic(1)} : motion(x);
        piece.y[0][j] = state.theta;
        piece.y[1][j] = moves(piece) ? state.velocity : piece.carrier(j);
        for (std::size_t k = 2; k < n_; ++k) piece.y[k][j] = cubic(k);
    }
    for (std::size_t k = 0; k < n_; ++k) piece.y[k][node_count - 1] = z[k];
    for (std::size_t j = 0; j < node_count; ++j) {
        if (!evaluate(piece, j, j == 0 ? departing : model::State{piece.y[0][j], piece.y[1][j]})) {
            return Attempt::failed;
        }
    }
    return Attempt::resolved;
}

}  // namespace dinal::motion::hybrid
