#include "analysis/misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "algebra/decompositions.hpp"
#include "analysis/least_squares.hpp"

namespace dinal::analysis {
namespace {

/// The matrix of inner products of columns. Columns can be eliminated one by one; the products are then those of the
/// components orthogonal to them.
class Products {
public:
    explicit Products(const Eigen::MatrixXd& all) : left_(all.transpose() * all), whole_(left_.diagonal()) {}

    /// The fraction of a column's length that is orthogonal to the eliminated columns.
    [[nodiscard]] double own(Eigen::Index i) const { return std::sqrt(std::max(0.0, left_(i, i)) / whole_[i]); }
    [[nodiscard]] double operator()(Eigen::Index i, Eigen::Index j) const { return left_(i, j); }
    void take_out(Eigen::Index i) {
        constexpr double dependent = 1e-6;
        if (!(own(i) > dependent)) return;
        const Eigen::VectorXd column = left_.col(i);
        left_ -= column * (column.transpose() / column[i]);
        ++taken_;
    }
    [[nodiscard]] int taken() const { return taken_; }

private:
    Eigen::MatrixXd left_;
    Eigen::VectorXd whole_;
    int taken_ = 0;
};

/// Significance in standard deviations: from the first a term adds to the errors, from the second it counts as present.
constexpr double possible = 2.2, beyond_chance = 4;

/// Removes a correlation with the previous sample (a memory of one step), in each measured column separately.
class Filter {
public:
    Filter(std::span<const int> columns, const Eigen::VectorXd& residual, int fitted) : before_(columns.size(), -1) {
        std::vector<Eigen::Index> last;
        double products = 0, squares = 0;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const auto column = static_cast<std::size_t>(columns[i]);
            if (last.size() <= column) last.resize(column + 1, -1);
            const auto now = static_cast<Eigen::Index>(i);
            before_[i] = std::exchange(last[column], now);
            squares += residual[now] * residual[now];
            if (before_[i] >= 0) products += residual[now] * residual[before_[i]];
        }
        // Each fitted parameter removes part of the slow noise and so reduces the measured memory.
        const double n = static_cast<double>(columns.size()), found = squares > 0 ? products / squares : 0;
        constexpr double most = 0.98;
        memory_ = std::clamp(found + (1 + std::max(found, 0.0)) * (fitted + 1) / n, 0.0, most);
    }

    [[nodiscard]] Eigen::MatrixXd operator()(const Eigen::MatrixXd& all) const {
        Eigen::MatrixXd filtered = all;
        const double first = std::sqrt(1 - memory_ * memory_);
        for (std::size_t i = 0; i < before_.size(); ++i) {
            const auto now = static_cast<Eigen::Index>(i);
            if (before_[i] >= 0) {
                filtered.row(now) -= memory_ * all.row(before_[i]);
            } else {
                filtered.row(now) *= first;
            }
        }
        return filtered;
    }

    /// The covariance matrix of noise with that memory times `all`, by one recursion forwards and one backwards.
    [[nodiscard]] Eigen::MatrixXd remembered(const Eigen::MatrixXd& all) const {
        Eigen::MatrixXd behind = all, before = all;
        for (std::size_t i = 0; i < before_.size(); ++i) {
            const auto now = static_cast<Eigen::Index>(i);
            if (before_[i] >= 0) behind.row(now) += memory_ * behind.row(before_[i]);
        }
        for (std::size_t i = before_.size(); i-- > 0;) {
            const auto now = static_cast<Eigen::Index>(i);
            if (before_[i] >= 0) before.row(before_[i]) += memory_ * before.row(now);
        }
        return behind + before - all;
    }

private:
    std::vector<Eigen::Index> before_;
    double memory_ = 0;
};

/// The matrix [a b]; missing rows are zero.
Eigen::MatrixXd beside(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
    Eigen::MatrixXd both(std::max(a.rows(), b.rows()), a.cols() + b.cols());
    if (a.cols() > 0) both.leftCols(a.cols()) = a;
    if (b.cols() > 0) both.rightCols(b.cols()) = b;
    return both;
}

/// Coefficients of the columns in y, and the remainder.
struct Regression {
    Eigen::VectorXd parts, rest;
};
Regression regression(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y) {
    const Eigen::VectorXd lengths = columns.colwise().norm().cwiseMax(1e-300);
    const Eigen::MatrixXd units = columns * lengths.cwiseInverse().asDiagonal();
    const Eigen::VectorXd parts = algebra::solve_least_squares(units, y);
    return {parts.cwiseQuotient(lengths), y - units * parts};
}

/// Searches the terms of a structure that explain more of a residual than noise could: the most significant one first,
/// then further ones. Each is tested in addition to the slopes, so that effects which the parameters can imitate do not
/// count.
class Search {
public:
    Search(const Eigen::VectorXd& residual, bool is_white, std::span<const int> columns, const Eigen::MatrixXd& slopes,
           const Structure& structure)
        : size_(residual.size()),
          first_(slopes.cols()),
          terms_(structure.columns.cols()),
          last_(first_ + terms_ + structure.faster.cols()),
          products_(products(residual, is_white, columns, slopes, structure)) {
        for (Eigen::Index i = 0; i < first_; ++i) products_.take_out(i);
        double squares = 0;
        for (Eigen::Index i = first_ + terms_; i < last_; ++i) squares += score(i) * score(i);
        const auto fast = static_cast<double>(structure.faster.cols());
        const double unit = fast > 0 ? std::max(1.0, std::sqrt(squares / fast)) : 1;
        for (double most = 0;;) {
            Eigen::Index which = -1;
            most = possible;
            for (Eigen::Index i = first_; i < first_ + terms_; ++i) {
                if (score(i) / unit > most) most = score(i) / unit, which = i;
            }
            if (which < 0) break;
            if (found_.empty()) most_ = most;
            found_.push_back(which - first_);
            products_.take_out(which);
        }
    }

    /// The significance of the first term, in standard deviations of chance; 0 if there is none.
    [[nodiscard]] double most() const { return most_; }
    [[nodiscard]] const std::vector<Eigen::Index>& found() const { return found_; }

private:
    /// The products of slopes, terms, faster terms and, last, the residual, filtered if the residual has a memory.
    static Products products(const Eigen::VectorXd& residual, bool is_white, std::span<const int> columns,
                             const Eigen::MatrixXd& slopes, const Structure& structure) {
        const Eigen::MatrixXd known = beside(slopes, structure.columns);
        const Eigen::MatrixXd all = beside(beside(known, structure.faster), residual);
        if (is_white) return Products(all);
        return Products(Filter(columns, regression(known, residual).rest, static_cast<int>(known.cols()))(all));
    }

    /// The significance of a column in the residual, in standard deviations.
    [[nodiscard]] double score(Eigen::Index i) const {
        constexpr double least_own_share = 0.02, least_spare = 8;
        if (!(products_.own(i) > least_own_share)) return 0;
        const double along = products_(i, last_), square = along * along / products_(i, i);
        const double spare = static_cast<double>(size_ - products_.taken() - 1),
                     left = products_(last_, last_) - square;
        return spare < least_spare || !(left > 0) ? 0 : std::sqrt(square * spare / left);
    }

    Eigen::Index size_, first_, terms_, last_;
    Products products_;
    double most_ = 0;
    std::vector<Eigen::Index> found_ = {};
};

/// Converts chi squared into standard deviations of a Gaussian (cube root of Wilson and Hilferty).
double deviations(double chi_squared, int more) {
    const double spread = 2.0 / (9 * more);
    return (std::cbrt(chi_squared / more) - (1 - spread)) / std::sqrt(spread);
}

double correlated(std::span<const double> x, std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum;
}

}  // namespace

Structure drift(std::span<const double> times, std::span<const int> columns, int column, bool is_white) {
    constexpr Eigen::Index slow = 4, most = 32;
    const auto n = static_cast<Eigen::Index>(times.size());
    const Eigen::Index all = slow + (is_white ? 0 : std::min<Eigen::Index>(most, n / 8));
    Eigen::MatrixXd drifts = Eigen::MatrixXd::Zero(n, all);
    const double span = times.back() - times.front();
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto place = static_cast<std::size_t>(i);
        if (columns[place] != column) continue;
        // The drift is 0 at the first time, because the fitted zero refers to it.
        const double angle = std::numbers::pi * (times[place] - times.front()) / span, twice = 2 * std::cos(angle);
        drifts(i, 0) = angle;
        double before = 1, now = twice / 2;
        for (Eigen::Index j = 1; j < all; ++j) {
            before = std::exchange(now, twice * now - before);
            drifts(i, j) = 1 - now;
        }
    }
    return {Follows::time, drifts.leftCols(slow), drifts.rightCols(all - slow)};
}

std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, bool is_white, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, std::span<const Structure> structures) {
    Misfit worst;
    Eigen::MatrixXd all = slopes;
    double most = 0;
    for (const Structure& structure : structures) {
        const Search search(residual, is_white, columns, slopes, structure);
        if (!(search.most() > most)) continue;
        most = search.most();
        worst.what = structure.what;
        all = slopes;
        for (const Eigen::Index i : search.found()) all = beside(all, structure.columns.col(i));
    }
    if (most == 0) return {};
    const Regression without = regression(all, residual);
    worst.is_sure = most > beyond_chance;
    worst.share = 1 - without.rest.squaredNorm() / residual.squaredNorm();
    worst.noise = without.rest.norm() / std::sqrt(std::max(1.0, static_cast<double>(all.rows() - all.cols())));
    worst.shift = without.parts.head(slopes.cols());
    return worst;
}

Eigen::VectorXd widened_by_memory(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole,
                                  const Eigen::VectorXd& residual, std::span<const int> columns, double noise,
                                  double widening) {
    const Filter filter(columns, residual, static_cast<int>(slopes.cols()));
    const Eigen::MatrixXd plain = covariance_of(slopes, whole, noise).matrix;
    const Eigen::MatrixXd wide = plain * (slopes.transpose() * filter.remembered(slopes)) * plain;
    const Eigen::VectorXd ratio = wide.diagonal().cwiseQuotient(plain.diagonal()) / (widening * widening);
    return ratio.cwiseMax(1).cwiseSqrt();
}

bool is_white(std::span<const double> residual, double unusual) {
    const double square = correlated(residual, 0), n = static_cast<double>(residual.size());
    if (!(square > 0)) return true;
    const std::size_t lags = std::min<std::size_t>(40, residual.size() / 4);
    double sum = 0;
    for (std::size_t lag = 1; lag <= lags; ++lag) {
        const double part = correlated(residual, lag) / square;
        sum += n * (n + 2) * part * part / (n - static_cast<double>(lag));
    }
    return lags == 0 || deviations(sum, static_cast<int>(lags)) < unusual;
}

bool has_only_memory(std::span<const double> residual) {
    const double memory = correlated(residual, 1) / correlated(residual, 0);
    std::vector<double> filtered;
    for (std::size_t i = 1; i < residual.size(); ++i) filtered.push_back(residual[i] - memory * residual[i - 1]);
    constexpr double very_unusual = 4;
    return memory > 0 && is_white(filtered, very_unusual);
}

double smallest_step(std::span<const double> values) {
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double apart = std::fabs(values[i] - values[i - 1]);
        if (apart > 0) step = std::min(step, apart);
    }
    return step;
}

double step_of_instrument(std::span<const double> values) {
    const double step = smallest_step(values);
    constexpr double rounding = 1e-6;
    const bool is_even = std::all_of(values.begin(), values.end(), [&](double x) {
        const double steps = (x - values.front()) / step;
        return std::fabs(steps - std::round(steps)) < rounding * std::max(1.0, std::fabs(steps));
    });
    return is_even ? step : 0;
}

}  // namespace dinal::analysis
