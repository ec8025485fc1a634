#include "analysis/misfit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "analysis/least_squares.hpp"
#include "model/terms/polyline.hpp"

namespace dinal::analysis {
namespace {

/// Orthogonal columns, and what is left of a vector without them.
class Subspace {
public:
    explicit Subspace(Eigen::VectorXd rest) : rest_(std::move(rest)) {}

    /// Adds the columns. Those that depend on earlier ones up to `least` of their length are left out. Returns how many
    /// were added.
    int add(const Eigen::MatrixXd& columns, double least) {
        int added = 0;
        for (Eigen::Index i = 0; i < columns.cols(); ++i) {
            Eigen::VectorXd column = columns.col(i);
            const double length = column.norm();
            constexpr int rounds = 2;
            for (int round = 0; round < rounds; ++round) {
                for (const Eigen::VectorXd& other : basis_) column -= other.dot(column) * other;
            }
            const double left = column.norm();
            if (!(left > least * length)) continue;
            column /= left;
            rest_ -= column.dot(rest_) * column;
            basis_.push_back(std::move(column));
            ++added;
        }
        return added;
    }
    [[nodiscard]] const Eigen::VectorXd& rest() const { return rest_; }
    [[nodiscard]] double left() const { return rest_.squaredNorm(); }
    [[nodiscard]] int size() const { return static_cast<int>(basis_.size()); }

private:
    Eigen::VectorXd rest_;
    std::vector<Eigen::VectorXd> basis_;
};

/// A drift is a sum of so many cosines of time.
constexpr int slow_cosines = 4;

constexpr double dependent = 1e-7, imitated = 1e-3;

/// Removes a memory of one step, in each measured column by itself.
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
        // Each fitted number takes a slow part of the noise away, and with it some of the memory.
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

    /// The covariance of noise with that memory times all: what is alike behind and before each row.
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

/// Of a likelihood ratio of `more` numbers in standard deviations (Wilson and Hilferty's root of chi squared).
double deviations(double chi_squared, int more) {
    const double spread = 2.0 / (9 * more);
    return (std::cbrt(chi_squared / more) - (1 - spread)) / std::sqrt(spread);
}

/// How far beyond chance `more` columns reduce a sum of squares; `spare` is what the greater model leaves free.
double significance(double before, double after, int more, double spare) {
    if (!(after > 0)) return std::numeric_limits<double>::infinity();
    return deviations((spare + more / 2.0 - 1) * std::log(before / after), more);
}

double correlated(std::span<const double> x, std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < x.size(); ++i) sum += x[i] * x[i + lag];
    return sum;
}

}  // namespace

Eigen::MatrixXd missing_torques(Follows what, std::span<const double> theta, std::span<const double> velocity) {
    const auto n = static_cast<Eigen::Index>(theta.size());
    const auto greatest = [](std::span<const double> values) {
        double most = std::numeric_limits<double>::min();
        for (const double x : values) most = std::max(most, std::fabs(x));
        return most;
    };
    const double far = greatest(theta), fast = greatest(velocity);
    Eigen::MatrixXd torques(n, what == Follows::theta ? 3 : 6);
    for (Eigen::Index i = 0; i < n; ++i) {
        const double x = theta[static_cast<std::size_t>(i)] / far, v = velocity[static_cast<std::size_t>(i)] / fast;
        const double way = v > 0 ? 1 : v < 0 ? -1 : 0;
        if (what == Follows::theta) {
            torques.row(i) << x, x * x, x * x * x;
        } else {
            constexpr double slow = 0.08, slower = 0.3;  // of the greatest speed: where friction may fall
            torques.row(i) << v, way, v * std::fabs(v), v * v, way * std::exp(-std::fabs(v) / slow),
                way * std::exp(-std::fabs(v) / slower);
        }
    }
    return torques;
}

std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, std::span<const double> times,
                                         const Eigen::MatrixXd& torques, double whole, double noise) {
    const auto here = pushed(model::Excitation());
    if (!here) return {};
    Eigen::MatrixXd columns(here->size(), torques.cols());
    double step = 1e-3 * whole;
    for (Eigen::Index i = 0; i < torques.cols(); ++i) {
        auto samples = std::make_shared<model::terms::Samples>();
        samples->t.assign(times.begin(), times.end());
        samples->M.assign(torques.col(i).begin(), torques.col(i).end());
        const auto torque = model::Excitation::make(model::terms::Polyline(std::move(samples))).value();
        constexpr int most_tries = 6;
        for (int tries = 0; tries < most_tries; ++tries) {
            const auto there = pushed(torque.scaled(step));
            if (!there) return {};
            columns.col(i) = (*there - *here) / step;
            const double change = (*there - *here).norm();
            constexpr double least = 0.5, most = 10, widest = 1e3;  // of the noise, all samples together
            if (change > least * noise && change < most * noise) break;
            step *= std::clamp(noise / std::max(change, 1e-300), 1 / widest, widest);
        }
        step = std::clamp(step, 1e-9 * whole, whole);
    }
    return columns;
}

Structure drift(std::span<const double> times, std::span<const int> columns, int column) {
    const auto n = static_cast<Eigen::Index>(times.size());
    const Eigen::Index slow = slow_cosines, fast = std::min<Eigen::Index>(32, n / 8);
    Eigen::MatrixXd cosines = Eigen::MatrixXd::Zero(n, slow + fast);
    const double span = times.back() - times.front();
    for (Eigen::Index i = 0; i < n; ++i) {
        const auto place = static_cast<std::size_t>(i);
        if (columns[place] != column) continue;
        const double part = std::numbers::pi * (times[place] - times.front()) / span;
        // From 0 at the first time on, as the fitted zero is that of the first time.
        for (Eigen::Index j = 0; j < slow + fast; ++j) cosines(i, j) = 1 - std::cos(static_cast<double>(j + 1) * part);
    }
    return {Follows::time, cosines.leftCols(slow), cosines.rightCols(fast)};
}

std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole,
                                std::span<const Structure> structures) {
    constexpr double beyond_chance = 4, possible = 2;
    std::optional<Misfit> worst;
    for (const Structure& structure : structures) {
        Subspace plain(residual);
        plain.add(slopes, dependent);
        const double all = plain.left();
        plain.add(structure.columns, imitated);
        const Filter filter(columns, plain.rest(), plain.size());

        Subspace white(filter(residual).col(0));
        white.add(filter(slopes), dependent);
        const double before = white.left();
        const int more = white.add(filter(structure.columns), imitated);
        const double after = white.left();
        const double spare = static_cast<double>(residual.size()) - white.size();
        constexpr double least_spare = 8;
        if (more == 0 || spare < least_spare) continue;
        const double likely = significance(before, after, more, spare);
        double sure = likely;
        if (structure.faster.cols() > 0) {
            const int rapid = white.add(filter(structure.faster), imitated);
            const double noise = after - white.left();
            sure = rapid < 4 ? 0 : std::min(likely, significance(before - after + noise, noise, more, rapid));
        }
        Misfit found{structure.what, sure > beyond_chance, 1 - plain.left() / all, 0, {}, {}};
        const auto rank = [](const Misfit& one) { return std::pair(one.is_sure, one.share); };
        if (likely < possible || (worst && rank(found) <= rank(*worst))) continue;
        found.noise = std::sqrt(plain.left() / spare);
        const Eigen::Index n = slopes.cols(), k = structure.columns.cols();
        Eigen::MatrixXd both(residual.size(), n + k);
        both << slopes, structure.columns;
        Eigen::VectorXd scale(n + k);
        for (Eigen::Index i = 0; i < k; ++i) scale[n + i] = residual.norm() / structure.columns.col(i).norm();
        scale.head(n) = whole;
        const Covariance covariance = covariance_of(both, scale, found.noise);
        found.shift = (covariance.matrix * (both.transpose() * residual)).head(n);
        found.covariance = found.noise * found.noise * covariance.matrix.topLeftCorner(n, n);
        worst = std::move(found);
    }
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

bool may_drift(std::span<const double> times, std::span<const double> residual) {
    std::array<double, slow_cosines> products{}, squares{};
    const double span = times.back() - times.front();
    for (std::size_t i = 0; i < times.size(); ++i) {
        const double twice = 2 * std::cos(std::numbers::pi * (times[i] - times.front()) / span);
        double before = 1, now = twice / 2;
        for (std::size_t j = 0; j < slow_cosines; ++j) {
            products[j] += now * residual[i], squares[j] += now * now;
            before = std::exchange(now, twice * now - before);
        }
    }
    double sum = 0;
    for (std::size_t j = 0; j < slow_cosines; ++j) sum += products[j] * products[j] / squares[j];
    const double variance = correlated(residual, 0) / static_cast<double>(residual.size());
    constexpr double unusual = 2;
    return variance > 0 && deviations(sum / variance, slow_cosines) > unusual;
}

bool has_only_memory(std::span<const double> residual) {
    const double memory = correlated(residual, 1) / correlated(residual, 0);
    std::vector<double> filtered;
    for (std::size_t i = 1; i < residual.size(); ++i) filtered.push_back(residual[i] - memory * residual[i - 1]);
    constexpr double very = 4;
    return memory > 0 && is_white(filtered, very);
}

double smallest_step(std::span<const double> values) {
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double apart = std::fabs(values[i] - values[i - 1]);
        if (apart > 0) step = std::min(step, apart);
    }
    return step;
}

}  // namespace dinal::analysis
