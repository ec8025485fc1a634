// Where the search of identify() starts: from the extremes of a free decay, or by the weak form of the driven equation.
#include "algebra/decompositions.hpp"
#include "analysis/drive.hpp"
#include "analysis/identification_search.hpp"

namespace dinal::analysis {
namespace {

/// S' = slope S - lost
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

/// A search may fly to a velocity that is gone between two samples: so it also begins with a mass that was let go.
void Identification::try_let_go(const std::vector<Parameters>& starts) {
    if (is_given(Unknown::velocity0)) return;
    const Eigen::Index place = place_of(Unknown::velocity0);
    for (const Parameters& start : starts) {
        if (stopped_ || !((question_.M && &start == starts.data()) || leaves_pattern(suspected))) return;
        base_ = start;
        at(base_, Unknown::velocity0) = 0;
        const FitScale scale = scale_of(base_);
        FitScale held = scale;
        held.hold[place] = firmly * range_ / scale.typical[place];
        const auto let_go = fit(fitted_of(base_), question_.t.size(), held, 40);
        const auto all = let_go ? fit(let_go->parameters, question_.t.size(), scale, 40) : std::nullopt;
        if (all && all->sum < best_->sum) moving_ = all->parameters;
        keep_if_better(all, scale);
    }
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
    const model::Excitation& M = *question_.M;
    const bool asks_all = std::isfinite(M.most()) && !M.has_feedback();  // its jumps are known, and it costs little
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
    std::vector<std::size_t> columns;
    for (std::size_t c = 0; c < 5; ++c) {
        const bool known =
            c < 4 ? is_given(order[c]) : question_.given[static_cast<std::size_t>(Unknown::offset)] == 0.0;
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
            for (Eigen::Index j = 0; j < m; ++j) A(i, j) = row[columns[static_cast<std::size_t>(j)]];
        }
        // Of one length each: which of them says nothing is not for the units to decide.
        const Eigen::VectorXd lengths = A.colwise().norm().cwiseMax(1e-300);
        const Eigen::VectorXd solved = algebra::solve_least_squares(A * lengths.cwiseInverse().asDiagonal(), b);
        for (Eigen::Index j = 0; j < m; ++j) x[columns[static_cast<std::size_t>(j)]] = solved[j] / lengths[j];
    }
    const double omega = turns_.size() >= 2 ? std::numbers::pi * static_cast<double>(turns_.size() - 1) /
                                                  (question_.t[turns_.back()] - question_.t[turns_.front()])
                                            : 2 * std::numbers::pi / span_;
    // Where noise or stops leave nothing, a system that could be.
    double most = 0;
    for (const double t : question_.t) most = std::max(most, std::fabs(question_.M->value(t)));
    if (!(x[1] > 0)) x[1] = x[0] > 0 ? x[0] * omega * omega : 2 * most / range_;
    if (!(x[0] > 0)) x[0] = x[1] / (omega * omega);
    if (x[1] > x[0] * highest_omega0() * highest_omega0()) {
        (is_given(Unknown::I) ? x[1] : x[0]) = is_given(Unknown::I) ? x[0] * omega * omega : x[1] / (omega * omega);
    }
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

// ---- another valley
//
// Dry and viscous friction take about the same from a motion of one size, and a mass that stands stops as long under
// many loads: the search may end in a valley beside the right one, or where nothing moves. There what is left shows.

/// Looks at systems of other natural frequencies, losses and shares of dry friction in them, and goes on from the best.
void Identification::try_other_valleys() {
    const double before = best_->sum;
    std::vector<std::pair<double, Parameters>> looks;
    const std::size_t rows = question_.t.size();
    for (const Parameters& from : {filled_best(), weak_form()}) {
        const double I = at(from, Unknown::I), k = at(from, Unknown::k);
        for (const double faster : {0.6, 0.8, 1.0, 1.25, 1.6}) {
            Parameters p = from;
            if (!is_given(Unknown::I)) at(p, Unknown::I) = I / (faster * faster);
            if (is_given(Unknown::I) && !is_given(Unknown::k)) at(p, Unknown::k) = k * faster * faster;
            const double omega0 = std::sqrt(at(p, Unknown::k) / at(p, Unknown::I));
            const double speed = range_ * omega0 * std::numbers::pi / 8;  // the mean one of a swing over half the range
            const double least = 0.02 * k * range_, most = k * range_;
            const double lost = std::clamp(at(from, Unknown::C) * speed + at(from, Unknown::Rd), least, most);
            for (const double more : {0.5, 1.0, 2.0}) {
                for (const double dry : {0.05, 0.35, 0.65, 0.95}) {
                    for (const double breakaway : {1.05, 1.4}) {
                        at(p, Unknown::Rd) = given(Unknown::Rd, dry * more * lost);
                        at(p, Unknown::C) = given(Unknown::C, (1 - dry) * more * lost / speed);
                        at(p, Unknown::Re) = given(Unknown::Re, breakaway * at(p, Unknown::Rd));
                        const auto theta = stopped_ ? std::nullopt : predicted(p, rows);
                        if (theta) looks.emplace_back((measured_ - *theta).squaredNorm(), p);
                    }
                }
            }
        }
    }
    std::sort(looks.begin(), looks.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    constexpr std::size_t tries = 8;
    for (std::size_t i = 0; i < std::min(tries, looks.size()); ++i) {
        if (!stopped_ && leaves_pattern(suspected)) try_from(looks[i].second);
    }
    if (best_->sum < (1 - same_fit) * before && !stopped_) try_jumps();
}

// ---- how a driven mass began
//
// A mass that M cannot move at first stays where it is at each small velocity, too: at 0 nothing depends on the
// velocity. So the beginning of the record is fitted from velocities of all sizes, and fits of all of it go on from
// there.

/// Fits the first angle and velocity to the beginning of the record, the other parameters being as they are, from
/// velocities of both signs and all sizes, or where that is given from such angles. Goes on from the best ones where
/// they are better than the best fit is there. True when one of them is better.
bool Identification::try_other_beginnings() {
    std::vector<Unknown> first;
    for (const Unknown which : {Unknown::velocity0, Unknown::theta0}) {
        if (!is_given(which)) first.push_back(which);
    }
    if (first.empty()) return false;
    const Parameters best = filled_best();
    const double before = best_->sum;
    const FitScale scale = scale_of(best);
    const auto size = static_cast<Eigen::Index>(first.size());
    FitScale of_first{Eigen::VectorXd(size), Eigen::VectorXd::Constant(size, -1e300), Eigen::VectorXd(size),
                      Eigen::VectorXd::Zero(size)};
    Eigen::VectorXd now(size);
    for (Eigen::Index i = 0; i < size; ++i) {
        const Unknown which = first[static_cast<std::size_t>(i)];
        of_first.typical[i] = scale.typical[place_of(which)];
        now[i] = at(best, which);
    }
    const auto with = [&](const Eigen::VectorXd& q) {
        Parameters p = best;
        for (Eigen::Index i = 0; i < size; ++i) at(p, first[static_cast<std::size_t>(i)]) = q[i];
        return p;
    };
    const double half = std::numbers::pi * std::sqrt(at(best, Unknown::I) / at(best, Unknown::k));
    const auto until = std::upper_bound(question_.t.begin(), question_.t.end(), question_.t.front() + half);
    constexpr std::ptrdiff_t least_rows = 8;
    const auto rows = static_cast<std::size_t>(std::max(until - question_.t.begin(), least_rows));
    const Prediction model = [&](const Eigen::VectorXd& q) { return predicted(with(q), rows); };
    const auto head = static_cast<Eigen::Index>(rows);
    const double whole = scale.whole[place_of(first.front())];
    std::vector<LeastSquares> found;
    for (const double part : {0.03, -0.03, 0.1, -0.1, 0.3, -0.3, 1.0, -1.0}) {
        Eigen::VectorXd q = now;
        q[0] = part * whole + (first.front() == Unknown::theta0 ? now[0] : 0);
        constexpr int steps = 10;
        auto one = least_squares(model, measured_.head(head), q, of_first, steps);
        if (one) found.push_back(std::move(*one));
    }
    std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.sum < b.sum; });
    const double told = best_->residual.head(head).squaredNorm();
    constexpr std::size_t tries = 2;
    for (std::size_t i = 0; i < std::min(tries, found.size()) && !stopped_; ++i) {
        if (is_settled() && found[i].sum > told - noise_ * noise_) break;
        if (i > 0 && is_same(found[i], found[i - 1])) continue;
        base_ = with(found[i].parameters);
        const FitScale from = scale_of(base_);
        keep_if_better(fit(fitted_of(base_), question_.t.size(), from, 30), from);
    }
    return best_->sum < (1 - same_fit) * before;
}

/// A mass that stops before there are many samples began elsewhere, as each velocity has it: that is how sure the first
/// angle is.
void Identification::see_short_beginnings() {
    const Parameters best = filled_best();
    const FitScale scale = scale_of(best);
    const double whole = scale.whole[place_of(Unknown::velocity0)];
    FitScale of_angle{Eigen::VectorXd::Constant(1, scale.typical[place_of(Unknown::theta0)]),
                      Eigen::VectorXd::Constant(1, -1e300), Eigen::VectorXd(1), Eigen::VectorXd::Zero(1)};
    for (const double side : {1.0, -1.0}) {
        double angle = at(best, Unknown::theta0);
        for (const double part : {0.02, 0.04, 0.06, 0.09, 0.13, 0.2}) {
            Parameters p = best;
            at(p, Unknown::velocity0) = side * part * whole;
            const Prediction model = [&](const Eigen::VectorXd& q) {
                at(p, Unknown::theta0) = q[0];
                return predicted(p, question_.t.size());
            };
            constexpr int steps = 4;
            const auto found = least_squares(model, measured_, Eigen::VectorXd::Constant(1, angle), of_angle, steps);
            if (!found) break;
            at(p, Unknown::theta0) = angle = found->parameters[0];
            seen_.emplace_back(found->sum, p);
            constexpr double possible = 16;
            if (found->sum > best_->sum + possible * deviation() * deviation()) break;
        }
    }
}

}  // namespace dinal::analysis
