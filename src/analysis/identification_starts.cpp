// Where the search of identify() starts: from the extremes of a free decay, or by the weak form of the driven equation.
#include <Eigen/QR>

#include "analysis/identification_search.hpp"

namespace dinal::analysis {
namespace {

/// S' = slope S - lost
std::pair<double, double> line_through(const std::vector<double>& swings) {
    const auto n = static_cast<Eigen::Index>(swings.size() - 1);
    Eigen::MatrixXd A(n, 2);
    Eigen::VectorXd b(n);
    for (Eigen::Index i = 0; i < n; ++i) {
        A.row(i) << swings[static_cast<std::size_t>(i)], -1;
        b[i] = swings[static_cast<std::size_t>(i) + 1];
    }
    const Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
    return {x[0], x[1]};
}

}  // namespace

Parameters Identification::common_start(double omega0, double zeta, double dry, double zero) const {
    Parameters p{};
    at(p, Unknown::I) =
        given(Unknown::I, is_given(Unknown::k) && omega0 > 0 ? given(Unknown::k, 1) / (omega0 * omega0) : 1);
    at(p, Unknown::k) = given(Unknown::k, at(p, Unknown::I) * omega0 * omega0);
    at(p, Unknown::C) = given(Unknown::C, 2 * zeta * std::sqrt(at(p, Unknown::I) * at(p, Unknown::k)));
    at(p, Unknown::Rd) = given(Unknown::Rd, dry * at(p, Unknown::k));
    at(p, Unknown::Re) = given(Unknown::Re, at(p, Unknown::Rd));
    at(p, Unknown::offset) = given(Unknown::offset, zero);
    const double a_while = 0.15 / omega0;  // so long it is about straight
    const auto bent = std::upper_bound(question_.t.begin(), question_.t.end(), question_.t.front() + a_while);
    const Tangent tangent =
        first_tangent(question_.t, question_.theta, static_cast<std::size_t>(bent - question_.t.begin()) + 2);
    at(p, Unknown::theta0) = given(Unknown::theta0, tangent.value - at(p, Unknown::offset));
    // A slope that noise could have made is none: a mass that stands is mostly one that was let go.
    const double samples = static_cast<double>(bent - question_.t.begin()) + 2;
    const double unsure = 3 * noise_ * std::sqrt(12 / samples) / a_while;
    at(p, Unknown::velocity0) = given(Unknown::velocity0, std::fabs(tangent.slope) < unsure ? 0 : tangent.slope);
    return p;
}

/// The half-cycle map X' - zero = -q (X - zero) -+ (1 + q) dry gives the rest of what the turning points say.
Parameters Identification::start_of(double q, double dry, double omega1) const {
    const double ratio = -std::log(q) / std::numbers::pi, zeta = ratio / std::hypot(1, ratio);
    double zero = 0;
    for (std::size_t i = 0; i + 1 < turns_.size(); ++i) {
        const double a = question_.theta[turns_[i]], b = question_.theta[turns_[i + 1]];
        zero += ((b + q * a) / (1 + q) - (a > b ? dry : -dry)) / static_cast<double>(turns_.size() - 1);
    }
    return common_start(omega1 / std::sqrt(1 - zeta * zeta), zeta, dry, zero);
}

std::vector<Parameters> Identification::free_starts() const {
    std::vector<Parameters> starts;
    const std::size_t n = turns_.size();
    if (n < 2) {
        const double rest = question_.theta.back();
        for (const double half : {0.5, 0.25, 1.0, 0.1, 2.0}) {
            for (const double zeta : {0.05, 0.5}) {
                starts.push_back(common_start(std::numbers::pi / (half * span_), zeta, 0.1 * range_, rest));
            }
            starts.push_back(common_start(std::numbers::pi / (half * span_), 1.5, 0.02 * range_, rest));
        }
        return starts;
    }
    const double omega1 =
        std::numbers::pi * static_cast<double>(n - 1) / (question_.t[turns_.back()] - question_.t[turns_.front()]);
    std::vector<double> swings;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        swings.push_back(std::fabs(question_.theta[turns_[i]] - question_.theta[turns_[i + 1]]));
    }
    const double steps = std::max(1.0, static_cast<double>(swings.size() - 1));
    const double q = std::clamp(std::pow(swings.back() / swings.front(), 1 / steps), 0.02, 0.9999);
    const double loss = std::max(0.0, (swings.front() - swings.back()) / (4 * steps));
    if (swings.size() >= 3) {
        const auto [slope, lost] = line_through(swings);
        if (slope > 0.05 && slope < 1.02 && lost > -0.02 * range_) {
            const double kept = std::min(slope, 0.9999);
            starts.push_back(start_of(kept, std::max(0.0, lost / (2 * (1 + kept))), omega1));
        }
    }
    starts.push_back(start_of(std::sqrt(q), loss / 2, omega1));
    starts.push_back(start_of(0.995, swings.size() > 1 ? loss : 0.05 * range_, omega1));
    starts.push_back(start_of(swings.size() > 1 ? q : 0.7, 1e-3 * range_, omega1));
    return starts;
}

std::vector<Parameters> Identification::forced_starts() const {
    std::vector<Parameters> starts;
    const Parameters weak = weak_form();
    for (const double factor : {1.0, 1.3, 0.7, 2.0}) {
        for (const double breakaway : {1.05, 1.4}) {
            Parameters p = weak;
            if (!is_given(Unknown::Rd)) at(p, Unknown::Rd) *= factor;
            if (!is_given(Unknown::Re)) at(p, Unknown::Re) = breakaway * at(p, Unknown::Rd);
            starts.push_back(p);
            if (is_given(Unknown::Re)) break;
        }
    }
    return starts;
}

/// On a stretch without a turn, with a bump w that is 0 with its first two slopes at both ends:
/// I int w'' theta - C int w' theta + k int w (theta - offset) + s Rd int w = int w M.
void Identification::add_window(std::size_t first, std::size_t last, double sign,
                                std::vector<std::array<double, 6>>& rows) const {
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
        row[5] += weight * w * question_.M->value(question_.t[i], {theta, 0});
    }
    rows.push_back(row);
}

Parameters Identification::weak_form() const {
    std::vector<std::array<double, 6>> rows;
    std::vector<std::size_t> edges{0};
    edges.insert(edges.end(), turns_.begin(), turns_.end());
    edges.push_back(question_.t.size() - 1);
    for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
        const std::size_t n = edges[i + 1] - edges[i];
        const double rise = question_.theta[edges[i + 1]] - question_.theta[edges[i]];
        if (n < 8 || std::fabs(rise) < 0.04 * range_) continue;
        const std::size_t margin = n / 10;  // about a turn or a stop the sign of the velocity is not sure
        const std::size_t begin = edges[i] + margin, end = edges[i + 1] - margin, third = (end - begin) / 3;
        const double sign = rise > 0 ? 1 : -1;
        add_window(begin, end, sign, rows);
        if (third >= 6) {
            add_window(begin, end - third, sign, rows);
            add_window(begin + third, end, sign, rows);
        }
    }
    // I, k, C, Rd and k offset; what is given goes to the other side.
    const std::array<Unknown, 4> order{Unknown::I, Unknown::k, Unknown::C, Unknown::Rd};
    std::vector<int> columns;
    for (int c = 0; c < 5; ++c) {
        const bool known = c < 4 ? is_given(order[static_cast<std::size_t>(c)])
                                 : question_.given[static_cast<std::size_t>(Unknown::offset)] == 0.0;
        if (!known) columns.push_back(c);
    }
    const auto n = static_cast<Eigen::Index>(rows.size()), m = static_cast<Eigen::Index>(columns.size());
    std::array<double, 5> x{};
    for (std::size_t c = 0; c < 4; ++c) x[c] = given(order[c], 0);
    if (n >= m && m > 0) {
        Eigen::MatrixXd A(n, m);
        Eigen::VectorXd b(n);
        for (Eigen::Index i = 0; i < n; ++i) {
            const auto& row = rows[static_cast<std::size_t>(i)];
            b[i] = row[5];
            for (std::size_t c = 0; c < 5; ++c) b[i] -= row[c] * x[c];
            for (Eigen::Index j = 0; j < m; ++j)
                A(i, j) = row[static_cast<std::size_t>(columns[static_cast<std::size_t>(j)])];
        }
        const Eigen::VectorXd solved = A.colPivHouseholderQr().solve(b);
        for (Eigen::Index j = 0; j < m; ++j)
            x[static_cast<std::size_t>(columns[static_cast<std::size_t>(j)])] = solved[j];
    }
    const double omega = turns_.size() >= 2 ? std::numbers::pi * static_cast<double>(turns_.size() - 1) /
                                                  (question_.t[turns_.back()] - question_.t[turns_.front()])
                                            : 2 * std::numbers::pi / span_;
    // Where noise or stops leave nothing, a system that could be.
    double most = 0;
    for (const double t : question_.t) most = std::max(most, std::fabs(question_.M->value(t)));
    if (!(x[1] > 0)) x[1] = x[0] > 0 ? x[0] * omega * omega : 2 * most / range_;
    if (!(x[0] > 0)) x[0] = x[1] / (omega * omega);
    x[2] = std::max(x[2], 0.0);
    x[3] = x[3] > 0 ? x[3] : is_given(Unknown::Rd) ? given(Unknown::Rd, 0) : 0.05 * most;
    const double omega0 = std::sqrt(x[1] / x[0]);
    Parameters p = common_start(omega0, 0, 0, x[4] / x[1]);
    at(p, Unknown::I) = x[0];
    at(p, Unknown::k) = x[1];
    at(p, Unknown::C) = x[2];
    at(p, Unknown::Rd) = x[3];
    at(p, Unknown::Re) = given(Unknown::Re, x[3]);
    return p;
}

}  // namespace dinal::analysis
