#include "analysis/noise_memory.hpp"

#include <algorithm>
#include <cmath>

#include "analysis/least_squares.hpp"

namespace dinal::analysis {
namespace {

/// The mean products of numbers that are 0, 1, ... `lags` places apart.
template <class Product>
Eigen::VectorXd mean_products(Eigen::Index lags, std::size_t n, Product product) {
    Eigen::VectorXd means = Eigen::VectorXd::Zero(lags + 1);
    for (Eigen::Index lag = 0; lag <= lags; ++lag) {
        const auto apart = static_cast<std::size_t>(lag);
        for (std::size_t i = 0; i + apart < n; ++i) means[lag] += product(i, i + apart);
    }
    return means / static_cast<double>(n);
}

/// Orthonormal columns that span those of A, without dependent ones.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& A) {
    if (A.cols() == 0) return A;
    Eigen::MatrixXd found(A.rows(), A.cols());
    Eigen::Index rank = 0;
    constexpr double dependent = 1e-6;
    for (Eigen::Index i = 0; i < A.cols(); ++i) {
        const double whole = A.col(i).norm();
        Eigen::VectorXd own = A.col(i);
        for (int again = 0; again < 2; ++again) {
            own -= found.leftCols(rank) * (found.leftCols(rank).transpose() * own);
        }
        if (own.norm() > dependent * whole) found.col(rank++) = own.normalized();
    }
    return found.leftCols(rank);
}

}  // namespace

NoiseMemory::NoiseMemory(const Eigen::VectorXd& residual, std::span<const int> columns, const Eigen::MatrixXd& slopes,
                         Eigen::Index lags)
    : lags_(lags) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const auto column = static_cast<std::size_t>(columns[i]);
        if (columns_.size() <= column) columns_.resize(column + 1);
        columns_[column].rows.push_back(static_cast<Eigen::Index>(i));
    }
    std::vector<Eigen::VectorXd> seen;
    for (Column& column : columns_) {
        const auto& rows = column.rows;
        seen.push_back(mean_products(
            lags_, rows.size(), [&](std::size_t i, std::size_t j) { return residual[rows[i]] * residual[rows[j]]; }));
        learn(column, seen.back());
    }
    if (none()) return;
    const Eigen::MatrixXd taken = basis_of(slopes);
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round) {
        const Eigen::MatrixXd along = remembered(taken), both = taken.transpose() * along,
                              rest = taken * both / 2 - along;
        std::vector<Eigen::VectorXd> lost;
        for (const Column& column : columns_) {
            const auto& rows = column.rows;
            lost.push_back(mean_products(lags_, rows.size(), [&](std::size_t i, std::size_t j) {
                return taken.row(rows[i]).dot(rest.row(rows[j])) + taken.row(rows[j]).dot(rest.row(rows[i]));
            }));
        }
        for (std::size_t i = 0; i < columns_.size(); ++i) learn(columns_[i], seen[i] - lost[i]);
    }
}

/// Finds weights from autocovariances by the recursion of Levinson and Durbin.
void NoiseMemory::learn(Column& column, const Eigen::VectorXd& covariances) const {
    const double n = static_cast<double>(column.rows.size());
    column.weights = {Eigen::VectorXd()};
    column.variances = {covariances[0]};
    if (!(covariances[0] > 0)) return;
    constexpr double most = 0.995, few = 10;
    const auto orders = std::min(lags_, static_cast<Eigen::Index>(n / few));
    double least = 0;  // gain of BIC over white noise
    std::size_t best = 1;
    for (Eigen::Index order = 1; order <= orders; ++order) {
        const Eigen::VectorXd& before = column.weights.back();
        const double along = covariances[order] - before.dot(covariances.segment(1, order - 1).reverse()),
                     reflected = std::clamp(along / column.variances.back(), -most, most);
        Eigen::VectorXd weights(order);
        weights << before - reflected * before.reverse(), reflected;
        column.variances.push_back(column.variances.back() * (1 - reflected * reflected));
        column.weights.push_back(weights);
        const double gain =
            n * std::log(column.variances.back() / covariances[0]) + static_cast<double>(order) * std::log(n);
        if (gain < least) least = gain, best = static_cast<std::size_t>(order) + 1;
    }
    column.weights.resize(best);
    column.variances.resize(best);
}

std::size_t NoiseMemory::order() const {
    std::size_t sum = 0;
    for (const Column& column : columns_) sum += column.weights.size() - 1;
    return sum;
}

Eigen::MatrixXd NoiseMemory::whitened(const Eigen::MatrixXd& all) const {
    Eigen::MatrixXd white = all;
    for (const Column& column : columns_) {
        for (std::size_t i = 0; i < column.rows.size(); ++i) {
            const std::size_t order = std::min(i, column.weights.size() - 1);
            const Eigen::VectorXd& weights = column.weights[order];
            auto row = white.row(column.rows[i]);
            for (std::size_t j = 0; j < order; ++j) {
                row -= weights[static_cast<Eigen::Index>(j)] * all.row(column.rows[i - 1 - j]);
            }
            if (order + 1 < column.variances.size()) {  // the first numbers have fewer before them
                row *= std::sqrt(column.variances.back() / column.variances[order]);
            }
        }
    }
    return white;
}

Eigen::MatrixXd NoiseMemory::remembered(const Eigen::MatrixXd& all) const {
    Eigen::MatrixXd product = all;
    for (const Column& column : columns_) {
        const auto order_at = [&](std::size_t i) { return std::min(i, column.weights.size() - 1); };
        const auto& rows = column.rows;
        for (std::size_t i = rows.size(); i-- > 0;) {
            const std::size_t order = order_at(i);
            for (std::size_t j = 0; j < order; ++j) {
                product.row(rows[i - 1 - j]) +=
                    column.weights[order][static_cast<Eigen::Index>(j)] * product.row(rows[i]);
            }
        }
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::size_t order = order_at(i);
            product.row(rows[i]) *= column.variances[order];
            for (std::size_t j = 0; j < order; ++j) {
                product.row(rows[i]) +=
                    column.weights[order][static_cast<Eigen::Index>(j)] * product.row(rows[i - 1 - j]);
            }
        }
    }
    return product;
}

Eigen::MatrixXd remembered_covariance(const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                      const Eigen::VectorXd& whole, double noise) {
    Eigen::MatrixXd plain = covariance_of(slopes, whole, noise).matrix;
    if (memory.none()) return plain;
    const Eigen::MatrixXd more = memory.remembered(slopes) / (noise * noise) - slopes;
    return plain + plain * (slopes.transpose() * more) * plain;
}

Eigen::VectorXd widened_by_memory(const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                  const Eigen::VectorXd& whole, double noise) {
    const Eigen::VectorXd plain = covariance_of(slopes, whole, noise).matrix.diagonal(),
                          wide = remembered_covariance(memory, slopes, whole, noise).diagonal();
    constexpr double least = 0.01;
    return wide.cwiseQuotient(plain).cwiseMax(least).cwiseSqrt();
}

Eigen::VectorXd widened_by_uneven_noise(const NoiseMemory& memory, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole, double noise) {
    const Eigen::MatrixXd white = memory.whitened(slopes), by = white * covariance_of(slopes, whole, noise).matrix;
    const Eigen::VectorXd taken = white.cwiseProduct(by).rowwise().sum();  // part of each number that the fit absorbs
    constexpr double most_taken = 0.5;
    const Eigen::VectorXd squares =
        memory.whitened(residual).col(0).cwiseAbs2().cwiseQuotient((1 - taken.array().min(most_taken)).matrix());
    const Eigen::MatrixXd weights = by.cwiseAbs2();
    const double mean = squares.mean(), spread = (squares.array() - mean).square().mean();
    if (!(spread > 0)) return Eigen::VectorXd::Ones(slopes.cols());
    const Eigen::ArrayXd sums = (mean * weights.colwise().sum()).transpose().array().max(1e-300),
                         chance = std::sqrt(spread) * weights.colwise().norm().transpose().array().max(1e-300),
                         ratio = (weights.transpose() * squares).array() / sums;
    // The ratio is nearly that of chi squared to its mean; its cube root is nearly Gaussian (Wilson and Hilferty).
    const Eigen::ArrayXd variance = (chance / sums).square() / 9;
    constexpr double unlikely = 2.5;
    const bool is_uneven = ((ratio.pow(1.0 / 3) - (1 - variance)) > unlikely * variance.sqrt()).any();
    if (!is_uneven) return Eigen::VectorXd::Ones(slopes.cols());
    return ratio.sqrt().matrix();
}

}  // namespace dinal::analysis
