// Pieces on which nothing depends on the motion but C velocity and k theta: the free motion, and the answer to what the
// load changes by. What a controller holds needs only the first.
#include <algorithm>
#include <cmath>

#include "motion/hybrid/integration.hpp"
#include "motion/hybrid/solver.hpp"

namespace dinal::motion::hybrid {

namespace {

constexpr double well_resolved = 1e-12;  // of the last coefficients: what they leave out is some hundred times less

/// The integral from the beginning of a piece of this half length.
Series integrated(const Series& rate, double h) {
    const auto longer = cheb::integral(rate, 0.0);
    Series whole{};
    for (std::size_t k = 0; k < node_count; ++k) whole[k] = h * longer[k];
    return whole;
}

bool is_resolved(const Series& series) {
    return cheb::tail(series) <= well_resolved * cheb::size(series);
}

}  // namespace

/// Of the piece's length, which is turned by the rounding of times to one that was there before.
Solver::Swing& Solver::swing_over(Solved& piece) {
    const double late = std::max(std::fabs(piece.start.hi), std::fabs(piece.end));
    const double near = std::min(1e-9 * piece.h, 4 * rounding * late);
    for (Swing& swing : swings_) {
        if (std::fabs(swing.h - piece.h) > near) continue;
        piece.h = swing.h;
        return swing;
    }
    Swing& swing = swings_[next_swing_];
    next_swing_ = (next_swing_ + 1) % swings_.size();
    const double h = piece.h, square = free_.w0_squared(), twice = free_.twice_delta();
    Nodes rate{};
    for (std::size_t j = 0; j < node_count; ++j) {
        const exact::FreeStep step = free_.after(h * (1 + cheb::nodes[j]));
        swing.moved.nodes[j] = step.moved;
        rate[j] = -(square * step.moved + twice * step.kept);
    }
    swing.h = h;
    swing.moved.series = cheb::fit(swing.moved.nodes);
    swing.slowed.series = integrated(cheb::fit(rate), h);
    swing.driven.series = integrated(swing.moved.series, h);
    swing.slowed.nodes = cheb::at_nodes(swing.slowed.series);
    swing.driven.nodes = cheb::at_nodes(swing.driven.series);
    swing.slowed.nodes[0] = swing.driven.nodes[0] = 0;
    swing.resolved = is_resolved(swing.moved.series) && is_resolved(cheb::fit(rate));
    swing.answer.resize(0, 0);
    return swing;
}

/// The free motion about where the load at the beginning would hold it.
void Solver::swing_on(Solved& piece, const Swing& swing) const {
    const double theta = piece.y[0][0], v = piece.y[1][0];
    const double torque = (piece.M[0] - system_.braking(piece.way)) + piece.push[0];
    const double a = accelerated(torque, piece.theta_at(0), 0);
    piece.f[1][0] = accelerated(torque, piece.theta_at(0), v);
    for (std::size_t j = 1; j < node_count; ++j) {
        piece.y[0][j] = theta + (v * swing.moved.nodes[j] + a * swing.driven.nodes[j]);
        piece.y[1][j] = v + (v * swing.slowed.nodes[j] + a * swing.moved.nodes[j]);
    }
    for (std::size_t k = 0; k < node_count; ++k) {
        piece.series[0][k] = v * swing.moved.series[k] + a * swing.driven.series[k];
        piece.series[1][k] = v * swing.slowed.series[k] + a * swing.moved.series[k];
    }
}

/// No step of Newton, and nothing to judge. Without a swing the mass stands.
Solver::Attempt Solver::go_on_held(Solved& piece, const Swing* swing) {
    const double M = field_.load({piece.times[0], piece.side(0), {piece.theta_at(0), piece.y[1][0]}, {}});
    unresolved_ = 0;
    bad_time_ = piece.times[0];
    if (!std::isfinite(M)) return Attempt::failed;
    piece.M.fill(M);
    if (swing == nullptr) {
        piece.y[1].fill(0);
        piece.series[0] = piece.series[1] = {};
        return Attempt::resolved;
    }
    swing_on(piece, *swing);
    end_in_time(piece);
    return std::isfinite(greatest(piece.y[0]) + greatest(piece.y[1])) ? Attempt::resolved : Attempt::failed;
}

/// What ends at a time to the letter ends a rounding of times off 2 h.
void Solver::end_in_time(Solved& piece) const {
    if (!piece.to_the_end) return;
    constexpr std::size_t last = node_count - 1;
    const double off = piece.start.until(piece.end) - 2 * piece.h, v = piece.y[1][last];
    const double torque = (piece.M[last] - system_.braking(piece.way)) + piece.push[last];
    piece.y[1][last] += off * accelerated(torque, piece.theta_at(last), v);
    piece.y[0][last] += off * v;
}

/// The inverse of 1 - h J times the integration, times that.
void Solver::prepare_answer(Swing& swing) const {
    const auto once = integration().bottomRightCorner<inner, inner>();
    const double h = swing.h;
    const Eigen::MatrixXd A = Eigen::MatrixXd::Identity(inner, inner) + h * free_.twice_delta() * once +
                              h * h * free_.w0_squared() * (once * once);
    swing.answer = A.partialPivLu().solve(h * once);
}

/// The free motion, and the answer to what the load changes by. It fails where M is not finite.
Solver::Attempt Solver::follow_load(Solved& piece, Swing& swing) {
    Eigen::Matrix<double, inner, 1> change, answer;
    for (std::size_t j = 0; j < node_count; ++j) {
        piece.M[j] = field_.load({piece.times[j], piece.side(j), {piece.theta_at(j), piece.y[1][j]}, {}});
        if (!std::isfinite(piece.M[j])) {
            bad_time_ = piece.times[j];
            return Attempt::failed;
        }
        const double more = (piece.M[j] - piece.M[0]) + (piece.push[j] - piece.push[0]);
        if (j > 0) change(static_cast<Eigen::Index>(j) - 1) = more / system_.inertia();
    }
    swing_on(piece, swing);
    if (swing.answer.size() == 0) prepare_answer(swing);
    answer.noalias() = swing.answer * change;
    change.noalias() = swing.h * (integration().bottomRightCorner<inner, inner>() * answer);
    for (std::size_t j = 1; j < node_count; ++j) {
        const auto i = static_cast<Eigen::Index>(j) - 1;
        piece.y[0][j] += change(i);
        piece.y[1][j] += answer(i);
    }
    end_in_time(piece);
    piece.f[0] = piece.y[1];
    for (std::size_t j = 0; j < node_count; ++j) {
        const double torque = (piece.M[j] - system_.braking(piece.way)) + piece.push[j];
        piece.f[1][j] = accelerated(torque, piece.theta_at(j), piece.y[1][j]);
    }
    return Attempt::resolved;
}

}  // namespace dinal::motion::hybrid
