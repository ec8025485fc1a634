// The memory of noise: how alike the errors of neighbouring samples are.
//
// In each measured column the noise counts as an autoregressive process: each number is a sum of multiples of the
// previous ones plus white noise. Its order has the least information criterion of Bayes (BIC), as in the covariance
// estimator VARHAC of den Haan and Levin. A fit absorbs part of the noise, mostly slow parts, so the residual has less
// memory than the noise; its autocovariances are corrected by what the fit would take from noise with that memory.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace dinal::analysis {

class NoiseMemory {
public:
    /// The greatest number of previous numbers on which a number may depend.
    static constexpr Eigen::Index most_lags = 8;

    /// `columns` has the measured column of each number, `slopes` the derivatives of the fit that left this residual.
    NoiseMemory(const Eigen::VectorXd& residual, std::span<const int> columns, const Eigen::MatrixXd& slopes,
                Eigen::Index lags = most_lags);

    /// The number of weights of previous numbers, in all columns.
    std::size_t order() const;
    /// Returns whether the noise is white.
    bool none() const { return order() == 0; }
    /// Combines rows so that noise with this memory becomes white.
    Eigen::MatrixXd whitened(const Eigen::MatrixXd& all) const;
    /// The covariance matrix of the noise times `all`.
    Eigen::MatrixXd remembered(const Eigen::MatrixXd& all) const;

private:
    /// The noise of one measured column.
    struct Column {
        std::vector<Eigen::Index> rows = {};
        std::vector<Eigen::VectorXd> weights = {};  ///< entry n: weights of the n previous numbers
        std::vector<double> variances = {};         ///< variances that these weights leave
    };
    void learn(Column& column, const Eigen::VectorXd& covariances) const;

    Eigen::Index lags_;
    std::vector<Column> columns_;
};

/// The covariance of the parameters of a fit with these derivatives to noise with this memory and the standard
/// deviation `noise`, in units of noise squared. `whole` is that of covariance_of().
Eigen::MatrixXd remembered_covariance(const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                      const Eigen::VectorXd& whole, double noise);

/// The factors by which the memory of the noise multiplies the errors of the parameters.
Eigen::VectorXd widened_by_memory(const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                  const Eigen::VectorXd& whole, double noise);

/// The mean factor of the errors above which its cause is reported.
inline constexpr double much_wider = 1.2;
/// The same factors for noise that is stronger in some parts of the record than in others (estimator HC2 of MacKinnon
/// and White), or 1 if that makes no error wider by more than chance.
Eigen::VectorXd widened_by_uneven_noise(const NoiseMemory& memory, const Eigen::VectorXd& residual,
                                        const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole, double noise);

}  // namespace dinal::analysis
