#include "motion/hybrid/solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "motion/interpolation.hpp"
#include "motion/spectral/break_search.hpp"
#include "motion/spectral/corner_look.hpp"

namespace dinal::motion::hybrid {

Solver::Solver(const Problem& problem, const Field& field, const Cut& cut)
    : system_(problem.system),
      free_(system_),
      slide_(system_),
      field_(field),
      cut_(cut),
      n_(2 + field.state_count()),
      linear_(n_ == 2 && !system_.has_remainder() && !field.asks_the_motion()),
      fastest_(n_ - 2),
      point_(n_),
      rate_(n_),
      other_rate_(n_) {}

/// False when one of the user's functions has failed.
bool Solver::sample_surroundings(Solved& piece) {
    const bool has_belt = field_.has_belt();
    for (std::size_t j = 0; j < node_count; ++j) {
        piece.push[j] = field_.push(piece.times[j], piece.side(j));
        piece.belt[j] = has_belt ? field_.belt(piece.times[j], piece.side(j)) : 0;
        if (!std::isfinite(piece.push[j] + piece.belt[j])) {
            bad_time_ = piece.times[j];
            return false;
        }
    }
    piece.belt_rate = {};
    if (!has_belt) return true;
    fastest_belt_ = std::max(fastest_belt_, greatest(piece.belt));
    const auto slope = cheb::derivative(cheb::fit(piece.belt));
    for (std::size_t j = 0; j < node_count; ++j) piece.belt_rate[j] = cheb::value(slope, cheb::nodes[j]) / piece.h;
    return true;
}

bool Solver::rates_of(const Solved& piece, double t, Side side, const model::State& asked, const Values& y,
                      double belt_rate, double* out, double& M, double push, double belt) const {
    const double theta = piece.origin + y[0];
    const MotionPoint at{t, side, {piece.origin + asked.theta, asked.velocity}, {y.data() + 2, n_ - 2}};
    M = field_.load(at);
    field_.rates(at, out + 2);
    if (moves(piece)) {
        const double friction = system_.braking(piece.way) +
                                slide_.friction_remainder(system_, piece.way, {theta, y[1] - belt}) +
                                system_.spring(theta);
        out[0] = y[1];
        out[1] = accelerated(((M - friction) + push), theta, y[1]);
    } else {
        out[0] = piece.leans ? 0 : belt;
        out[1] = piece.leans ? 0 : belt_rate;
    }
    return std::isfinite(M) && std::all_of(out, out + n_, [](double x) { return std::isfinite(x); });
}

double Solver::accelerated(double torque, double theta, double velocity) const {
    return (torque - system_.damping() * velocity - system_.stiffness() * theta) / system_.inertia();
}

bool Solver::evaluate(Solved& piece, std::size_t node, const model::State& asked) {
    for (std::size_t k = 0; k < n_; ++k) point_[k] = piece.y[k][node];
    const bool good = rates_of(piece, piece.times[node], piece.side(node), asked, point_, piece.belt_rate[node],
                               rate_.data(), piece.M[node], piece.push[node], piece.belt[node]);
    for (std::size_t k = 0; k < n_; ++k) piece.f[k][node] = rate_[k];
    if (!good) bad_time_ = piece.times[node];
    return good;
}

Solver::Attempt Solver::solve(Solved& piece, const Values& begin, const model::State& departing) {
    const bool linear = linear_ && cut_.h == 0;
    Swing* swing = linear && moves(piece) ? &swing_over(piece) : nullptr;
    if (swing != nullptr && !swing->resolved) swing = nullptr;
    piece.passed = false;
    piece.held = linear && field_.is_held(piece.time(0));
    for (std::size_t j = 0; j + 1 < node_count; ++j) piece.times[j] = piece.time(cheb::nodes[j]);
    piece.times[node_count - 1] = piece.end;
    piece.y.resize(n_), piece.f.resize(n_), piece.series.resize(n_);
    for (std::size_t k = 0; k < n_; ++k) piece.y[k].fill(begin[k]);
    if (piece.held && (swing != nullptr || !moves(piece))) return go_on_held(piece, swing);
    if (!sample_surroundings(piece)) return Attempt::failed;
    const Attempt attempt = cut_.h > 0         ? runge_kutta(piece, departing)
                            : swing != nullptr ? follow_load(piece, *swing)
                                               : collocate(piece, departing);
    if (attempt != Attempt::resolved) return attempt;
    for (std::size_t k = 0; k < n_; ++k) {
        Nodes change{};
        for (std::size_t j = 0; j < node_count; ++j) change[j] = piece.y[k][j] - begin[k];
        piece.series[k] = cheb::fit(change);
        if (!std::isfinite(greatest(change))) return Attempt::failed;
    }
    if (cut_.h > 0) return attempt;
    judge(piece);
    const bool known = slide_.inside() && !system_.has_spring();
    if (unresolved_ <= 1 && moves(piece) && system_.has_remainder() && !known) look_at_corners(piece);
    return unresolved_ <= 1 ? Attempt::resolved : Attempt::shorten;
}

/// The size of what acts on the mass, M among it, which may balance.
double Solver::torques_of(const Solved& piece, double M) const {
    return M + system_.greatest_holding() + system_.stiffness() * (greatest(piece.y[0]) + std::fabs(piece.origin)) +
           greatest(piece.push) + std::fabs(system_.spring(piece.origin + piece.y[0][0]));
}

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

/// The last coefficients of what drives each value, against what that value is and how it changes.
void Solver::judge(const Solved& piece) {
    unresolved_ = 0;
    const double h = piece.h, per_torque = h * (h / system_.inertia());
    const Series M = cheb::fit(piece.M);
    Series load = cheb::fit(piece.push);
    for (std::size_t k = 0; k < node_count; ++k) load[k] += M[k];
    const double torques = torques_of(piece, cheb::size(M));
    const double smallest = std::numeric_limits<double>::min() / rounding;
    // Times far from t = 0 are rounded, and with them what is asked at them. A jump is no slope.
    const double late = std::max(std::fabs(piece.start.hi), std::fabs(piece.end));
    const auto lost_in_time = [&](const Series& series, double most) {
        return engine::lost_in_time(series, late, h, most);
    };
    const double lost = lost_in_time(load, torques);
    if (moves(piece)) {
        Nodes w{};
        for (std::size_t j = 0; j < node_count; ++j) w[j] = h * h * piece.f[1][j];
        const Series series = cheb::fit(w);
        const double size = cheb::size(series);
        const double allowed = cut_.tolerance * std::max(h * greatest(piece.y[1]), size) +
                               64 * rounding * (size + per_torque * torques) + per_torque * lost + smallest;
        unresolved_ = cheb::tail(series) / allowed;
        uncertain_ = allowed / per_torque;
    } else {
        unresolved_ = cheb::tail(load) / ((cut_.tolerance + 16 * rounding) * torques + lost + smallest);
    }
    // Near a zero of a belt or of a rate its rounding is that of what it was before.
    if (field_.has_belt()) {
        const Series belt = cheb::fit(piece.belt);
        const double allowed = (cut_.tolerance + 16 * rounding) * greatest(piece.belt) + 16 * rounding * fastest_belt_ +
                               lost_in_time(belt, fastest_belt_) + smallest;
        unresolved_ = std::max(unresolved_, cheb::tail(belt) / allowed);
    }
    for (std::size_t k = 2; k < n_; ++k) {
        Nodes rate{};
        for (std::size_t j = 0; j < node_count; ++j) rate[j] = h * piece.f[k][j];
        const Series series = cheb::fit(rate);
        fastest_[k - 2] = std::max(fastest_[k - 2], greatest(piece.f[k]));
        const double allowed = (cut_.tolerance + 64 * rounding) * std::max(greatest(piece.y[k]), cheb::size(series)) +
                               64 * rounding * h * fastest_[k - 2] + lost_in_time(series, h * fastest_[k - 2]);
        unresolved_ = std::max(unresolved_, cheb::tail(series) / (allowed + smallest));
    }
}

/// Friction and springs may turn a corner where no node is.
void Solver::look_at_corners(const Solved& piece) {
    constexpr double too_short = 1e-6, clearly = 64;
    if (2 * piece.h <= too_short * cut_.longest) return;
    spectral::CornerLook look{system_, slide_, piece.way, piece.y[0], piece.y[1], {}};
    for (std::size_t j = 0; j < node_count; ++j) {
        look.theta[j] += piece.origin, look.slip[j] -= piece.belt[j];
        look.remainder[j] = system_.inertia() * (accelerated((piece.M[j] - system_.braking(piece.way)) + piece.push[j],
                                                             look.theta[j], piece.y[1][j]) -
                                                 piece.f[1][j]);
    }
    const auto missed = spectral::missed_corner(look, clearly * uncertain_);
    if (missed) unresolved_ = std::max(2.0, std::pow(0.9 / spectral::shorter_by_corner(*missed), cheb::degree));
}

double Solver::jump_of_belt(const Solved& piece) const {
    constexpr double clearly = 1e-6, near = 1e-3;
    const double seen = clearly * std::max(fastest_belt_, greatest(piece.belt));
    const auto [least, most] = std::minmax_element(piece.belt.begin(), piece.belt.end());
    const double change = *most - *least;
    std::size_t first = 1;  // of the greatest differences
    const auto difference = [&](std::size_t j) { return std::fabs(piece.belt[j] - piece.belt[j - 1]); };
    for (std::size_t j = 2; j < node_count; ++j) {
        if (difference(j) > 2 * difference(first)) first = j;
    }
    if (!(change > seen) || !(difference(first) > change / 4)) return model::never;
    const auto belt = [&](double t) { return field_.belt(t, Side::at); };
    const std::size_t from = std::max<std::size_t>(first, 2) - 2;
    const auto found =
        spectral::find_break(std::span(piece.times).subspan(from, 3), std::span(piece.belt).subspan(from, 3), belt);
    if (!found || !(*found > piece.start.hi)) return model::never;
    // Of noise a jump is no more than what lies beside it.
    const double right_before = std::min(std::nextafter(*found, -model::never), *found - spectral::nearest * piece.h);
    const double before = belt(std::max(right_before, piece.start.hi)), after = belt(*found);
    const double jump = std::fabs(after - before);
    if (!(jump > seen)) return model::never;
    for (const double part : {0.25, 0.5, 1.0}) {
        const double by = part * near * piece.h;
        const double off_before = std::fabs(belt(std::max(*found - by, piece.start.hi)) - before);
        const double off_after = std::fabs(belt(std::min(*found + by, piece.end)) - after);
        if (!(std::max(off_before, off_after) < jump / 4)) return model::never;
    }
    return *found;
}

void Solver::pass_over(Solved& piece) const {
    piece.passed = true;
    // Whatever jumps here, the belt goes on as it did before.
    piece.belt_rate.fill(field_.has_belt() ? field_.belt_slope(piece.start.hi).rate : 0);
    piece.push.fill(piece.push[0]), piece.belt.fill(piece.belt[0]);
    if (!moves(piece)) piece.f[1].fill(0);
    for (std::size_t k = 0; k < n_; ++k) {
        Nodes change{};
        for (std::size_t j = 1; j < node_count; ++j) {
            change[j] = piece.h * (1 + cheb::nodes[j]) * piece.f[k][0];
            piece.y[k][j] = piece.y[k][0] + change[j];
        }
        piece.series[k] = cheb::fit(change);
    }
    piece.M.fill(piece.M[0]);
}

}  // namespace dinal::motion::hybrid
