#include "analysis/fit_starts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "algebra/decompositions.hpp"
#include "analysis/repetition.hpp"

namespace dinal::analysis {

double noise_of(std::span<const double> theta) {
    if (theta.size() < 6) return 0;
    std::vector<double> differences;
    for (std::size_t i = 2; i + 2 < theta.size(); ++i) {
        differences.push_back(
            std::fabs(theta[i - 2] - 4 * theta[i - 1] + 6 * theta[i] - 4 * theta[i + 1] + theta[i + 2]));
    }
    const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
    std::nth_element(differences.begin(), middle, differences.end());
    return *middle / (0.6745 * std::sqrt(70.0));  // median of |x|, and 1 + 16 + 36 + 16 + 1, the sum of squared weights
}

bool is_noisy(std::span<const double> values) {
    std::vector<double> half;
    for (std::size_t i = 0; i < values.size(); i += 2) half.push_back(values[i]);
    const auto [low, high] = std::ranges::minmax_element(values);
    return noise_of(values) > std::max(1e-6 * (*high - *low), 0.5 * noise_of(half));
}

namespace {

std::size_t standing_at(std::span<const double> theta, double limit) {
    constexpr std::size_t least = 4;
    std::size_t all = 0;
    for (std::size_t i = 0; i < theta.size();) {
        std::size_t end = i;
        while (end < theta.size() && theta[end] == limit) ++end;
        if (end - i >= least && end < theta.size()) all += end - i;
        i = std::max(end, i + 1);
    }
    return all;
}

}  // namespace

CutOff cut_off(std::span<const double> theta) {
    const auto [low, high] = std::ranges::minmax_element(theta);
    return {*low, *high, standing_at(theta, *low), standing_at(theta, *high)};
}

std::vector<std::size_t> turning_points(std::span<const double> theta, double least) {
    std::vector<std::size_t> points;
    std::size_t high = 0, low = 0;
    int way = 0;
    for (std::size_t i = 1; i < theta.size(); ++i) {
        if (theta[i] > theta[high]) high = i;
        if (theta[i] < theta[low]) low = i;
        if (way >= 0 && theta[high] - theta[i] >= least) {
            if (way > 0) points.push_back(high);
            way = -1;
            low = i;
        } else if (way <= 0 && theta[i] - theta[low] >= least) {
            if (way < 0) points.push_back(low);
            way = 1;
            high = i;
        }
        if (way > 0) low = i;
        if (way < 0) high = i;
    }
    return points;
}

Tangent first_tangent(std::span<const double> t, std::span<const double> theta, std::size_t count) {
    count = std::clamp<std::size_t>(count, 2, theta.size());
    double t_mean = 0, mean = 0, above = 0, below = 0;
    for (std::size_t i = 0; i < count; ++i) t_mean += t[i], mean += theta[i];
    t_mean /= static_cast<double>(count);
    mean /= static_cast<double>(count);
    for (std::size_t i = 0; i < count; ++i) {
        above += (t[i] - t_mean) * (theta[i] - mean);
        below += (t[i] - t_mean) * (t[i] - t_mean);
    }
    const double slope = below > 0 ? above / below : 0;
    return {mean - slope * (t_mean - t[0]), slope};
}

namespace {

/// Fits S' = slope S - lost to successive swings.
std::pair<double, double> line_through(const std::vector<double>& swings) {
    const auto n = static_cast<Eigen::Index>(swings.size() - 1);
    Eigen::MatrixXd A(n, 2);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        A.row(i) << swings[static_cast<std::size_t>(i)], -swings.front();
        b[i] = swings[static_cast<std::size_t>(i) + 1];
    }
    const Eigen::VectorXd x = algebra::solve_least_squares(A, b);
    return {x[0], x[1] * swings.front()};
}

}  // namespace

MeasuredAngles::MeasuredAngles(const IdentifyQuestion& question)
    : theta(question.theta.size()),
      cut(cut_off(question.theta)),
      span(question.t.back() - question.t.front()),
      noise(noise_of(question.theta)),
      step(step_of_instrument(question.theta)) {
    std::ranges::copy(question.theta, theta.data());
    range = theta.maxCoeff() - theta.minCoeff();
    turns = turning_points(question.theta, std::clamp(6 * noise, 0.04 * range, 0.4 * range));
}

bool MeasuredAngles::ends_at_rest() const {
    const Eigen::Index n = theta.size();
    const auto tail = theta.tail(std::min(n, std::max<Eigen::Index>(8, n / 30)));
    return tail.maxCoeff() - tail.minCoeff() <= 8 * noise + 1e-6 * range;
}

double MeasuredAngles::highest_omega0() const {
    constexpr double whole_turn = 2 * std::numbers::pi;
    return whole_turn * static_cast<double>(theta.size() - 1) / span;
}

Parameters FitStarts::completed(double omega0, double zeta, double dry, double zero) const {
    Parameters p{};
    p.I = question_.given.I.value_or(question_.given.k && omega0 > 0 ? question_.given.k.value_or(1) / (omega0 * omega0)
                                                                     : 1);
    p.k = question_.given.k.value_or(p.I * omega0 * omega0);
    p.C = question_.given.C.value_or(2 * zeta * std::sqrt(p.I * p.k));
    p.Rd = question_.given.Rd.value_or(dry * p.k);
    p.Re = question_.given.Re.value_or(p.Rd);
    p.offset = question_.given.offset.value_or(zero);
    const double a_while = 0.15 / omega0;  // the motion is nearly straight for this time
    const auto bent = std::ranges::upper_bound(question_.t, question_.t.front() + a_while);
    const Tangent tangent =
        first_tangent(question_.t, question_.theta, static_cast<std::size_t>(bent - question_.t.begin()) + 2);
    p.theta0 = question_.given.theta0.value_or(tangent.value - p.offset);
    // A slope within the noise counts as 0, as most masses start at rest.
    const double samples = static_cast<double>(bent - question_.t.begin()) + 2;
    const double unsure = 3 * record_.noise * std::sqrt(12 / samples) / a_while;
    p.velocity0 = question_.given.velocity0.value_or(std::fabs(tangent.slope) < unsure ? 0 : tangent.slope);
    return p;
}

/// The half-cycle map X' - zero = -q (X - zero) -+ (1 + q) dry determines the remaining starting values from the
/// turning points.
Parameters FitStarts::start_of(double q, double dry, double omega1) const {
    const double ratio = -std::log(q) / std::numbers::pi, zeta = ratio / std::hypot(1, ratio);
    double zero = 0;
    for (std::size_t i = 0; i + 1 < record_.turns.size(); ++i) {
        const double a = question_.theta[record_.turns[i]], b = question_.theta[record_.turns[i + 1]];
        zero += ((b + q * a) / (1 + q) - (a > b ? dry : -dry)) / static_cast<double>(record_.turns.size() - 1);
    }
    return completed(omega1 / std::sqrt(1 - zeta * zeta), zeta, dry, zero);
}

std::vector<Parameters> FitStarts::free() const {
    std::vector<Parameters> starts;
    const std::size_t n = record_.turns.size();
    if (n < 2) {
        const double rest = question_.theta.back();
        for (const double half : {0.5, 0.25, 1.0, 0.1, 2.0}) {
            for (const double zeta : {0.05, 0.5}) {
                starts.push_back(completed(std::numbers::pi / (half * record_.span), zeta, 0.1 * record_.range, rest));
            }
            starts.push_back(completed(std::numbers::pi / (half * record_.span), 1.5, 0.02 * record_.range, rest));
        }
        return starts;
    }
    const double omega1 = std::numbers::pi * static_cast<double>(n - 1) /
                          (question_.t[record_.turns.back()] - question_.t[record_.turns.front()]);
    std::vector<double> swings;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        swings.push_back(std::fabs(question_.theta[record_.turns[i]] - question_.theta[record_.turns[i + 1]]));
    }
    const double steps = std::max(1.0, static_cast<double>(swings.size() - 1));
    const double q = std::clamp(std::pow(swings.back() / swings.front(), 1 / steps), 0.02, 0.9999);
    const double loss = std::max(0.0, (swings.front() - swings.back()) / (4 * steps));
    if (swings.size() >= 3) {
        const auto [slope, lost] = line_through(swings);
        if (slope > 0.05 && slope < 1.02 && lost > -0.02 * record_.range) {
            const double kept = std::min(slope, 0.9999);
            starts.push_back(start_of(kept, std::max(0.0, lost / (2 * (1 + kept))), omega1));
        }
    }
    starts.push_back(start_of(std::sqrt(q), loss / 2, omega1));
    starts.push_back(start_of(0.995, swings.size() > 1 ? loss : 0.05 * record_.range, omega1));
    starts.push_back(start_of(swings.size() > 1 ? q : 0.7, 1e-3 * record_.range, omega1));
    return starts;
}

std::vector<Parameters> FitStarts::forced() const {
    std::vector<Parameters> starts;
    const Parameters weak = weak_form();
    for (const double factor : {1.0, 1.3, 0.7, 2.0}) {
        for (const double breakaway : {1.05, 1.4}) {
            Parameters p = weak;
            if (!question_.given.Rd) p.Rd *= factor;
            if (!question_.given.Re) p.Re = breakaway * p.Rd;
            starts.push_back(p);
            if (question_.given.Re) break;
        }
    }
    return starts;
}

Parameters FitStarts::weak_form() const {
    std::vector<std::array<double, 6>> rows;
    std::vector<std::size_t> edges{0};
    edges.insert(edges.end(), record_.turns.begin(), record_.turns.end());
    edges.push_back(question_.t.size() - 1);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const std::size_t n = edges[i + 1] - edges[i];
        const double rise = question_.theta[edges[i + 1]] - question_.theta[edges[i]];
        if (n < 8 || std::fabs(rise) < 0.04 * record_.range) continue;
        const std::size_t margin = n / 10;  // near a turn or stop the sign of the velocity is uncertain
        const std::size_t begin = edges[i] + margin, end = edges[i + 1] - margin, third = (end - begin) / 3;
        const double sign = rise > 0 ? 1 : -1;
        add_window(begin, end, sign, rows);
        if (third >= 6) {
            add_window(begin, end - third, sign, rows);
            add_window(begin + third, end, sign, rows);
        }
    }
    // The unknowns are I, k, C, Rd and k offset; given values move to the right-hand side.
    const std::array<Unknown, 4> order{Unknown::I, Unknown::k, Unknown::C, Unknown::Rd};
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < 5; ++c) {
        const bool known = c < 4 ? question_.gives(order[c]) : question_.given.offset == 0.0;
        if (!known) columns.push_back(c);
    }
    const auto n = static_cast<Eigen::Index>(rows.size()), m = static_cast<Eigen::Index>(columns.size());
    std::array<double, 5> x{};
    for (std::size_t c = 0; c < 4; ++c) x[c] = at(question_.given, order[c]).value_or(0);
    if (n >= m && m > 0) {
        Eigen::MatrixXd A(n, m);
        Eigen::VectorXd b(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto& row = rows[static_cast<std::size_t>(i)];
            b[i] = row[5];
            for (std::size_t c = 0; c < 5; ++c) b[i] -= row[c] * x[c];
            for (Eigen::Index j = 0; j < m; ++j) A(i, j) = row[columns[static_cast<std::size_t>(j)]];
        }
        // Columns are normalised, so that units do not affect which of them counts as dependent.
        const Eigen::VectorXd lengths = A.colwise().norm().cwiseMax(1e-300);
        const Eigen::VectorXd solved = algebra::solve_least_squares(A * lengths.cwiseInverse().asDiagonal(), b);
        for (Eigen::Index j = 0; j < m; ++j) x[columns[static_cast<std::size_t>(j)]] = solved[j] / lengths[j];
    }
    const double omega = record_.turns.size() >= 2
                             ? std::numbers::pi * static_cast<double>(record_.turns.size() - 1) /
                                   (question_.t[record_.turns.back()] - question_.t[record_.turns.front()])
                             : 2 * std::numbers::pi / record_.span;
    // If noise or stops prevent an estimate, use a system with the scales of the record.
    double most = 0;
    for (const double t : question_.t) most = std::max(most, std::fabs(question_.M->value(t)));
    if (!(x[1] > 0)) x[1] = x[0] > 0 ? x[0] * omega * omega : 2 * most / record_.range;
    if (!(x[0] > 0)) x[0] = x[1] / (omega * omega);
    if (x[1] > x[0] * record_.highest_omega0() * record_.highest_omega0()) {
        (question_.given.I ? x[1] : x[0]) = question_.given.I ? x[0] * omega * omega : x[1] / (omega * omega);
    }
    x[2] = std::max(x[2], 0.0);
    x[3] = x[3] > 0 ? x[3] : question_.given.Rd.value_or(0.05 * most);
    const double omega0 = std::sqrt(x[1] / x[0]);
    Parameters p = completed(omega0, 0, 0, x[4] / x[1]);
    p.I = x[0];
    p.k = x[1];
    p.C = x[2];
    p.Rd = x[3];
    p.Re = question_.given.Re.value_or(x[3]);
    return p;
}

/// Adds the weak form on an interval without a turn, with a bump w whose value and first two derivatives vanish at
/// both ends: I int w'' theta - C int w' theta + k int w (theta - offset) + s Rd int w = int w M.
void FitStarts::add_window(std::size_t first, std::size_t last, double sign,
                           std::vector<std::array<double, 6>>& rows) const {
    const model::Excitation& M = *question_.M;
    // the jumps of M are known, and it is cheap to evaluate
    const bool asks_all = std::isfinite(M.most()) && !M.has_feedback();
    const double a = question_.t[first], length = question_.t[last] - a;
    std::array<double, 6> row{};
    for (std::size_t i = first; i <= last; ++i) {
        const double s = (question_.t[i] - a) / length, u = s * (1 - s), du = (1 - 2 * s) / length;
        const double weight = (question_.t[std::min(i + 1, last)] - question_.t[i == first ? i : i - 1]) / 2;
        const double w = u * u * u, w1 = 3 * u * u * du, w2 = 6 * u * du * du - 6 * u * u / (length * length);
        const double theta = question_.theta[i];
        row[0] += weight * w2 * theta;
        row[1] += weight * w * theta;
        row[2] -= weight * w1 * theta;
        row[3] += weight * w * sign;
        row[4] -= weight * w;
        if (!asks_all) row[5] += weight * w * M.value(question_.t[i], {theta, 0});
    }
    if (asks_all) {
        constexpr double pieces = 16;
        row[5] = integral(M, a, a + length, length / pieces, [&](double t) {
            const double s = (t - a) / length, u = s * (1 - s);
            return u * u * u * M.value(t);
        });
    }
    rows.push_back(row);
}

}  // namespace dinal::analysis
