// Levenberg and Marquardt's method for simulated models: derivatives by differences, bounds by projection.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace dinal::analysis {

/// Returns the model's values for these parameters; empty if it cannot be evaluated.
using Prediction = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters)>;

struct LeastSquares {
    Eigen::VectorXd parameters, residual;  ///< residual: measured minus predicted
    double sum = 0;                        ///< sum of squared residuals
};

struct FitScale {
    Eigen::VectorXd typical;  ///< typical size of each parameter, used while it is 0
    Eigen::VectorXd least;    ///< lower bound of each parameter
    Eigen::VectorXd whole;    ///< an error this large means that the parameter is undetermined
    /// adds |hold (p - start)|^2 to the sum, which keeps parameters without influence in place
    Eigen::VectorXd hold;
};

/// The local minimum of the sum of squares found from `start`; empty if the model cannot be evaluated there.
std::optional<LeastSquares> least_squares(const Prediction& model, const Eigen::VectorXd& measured,
                                          const Eigen::VectorXd& start, const FitScale& scale, int most_steps);

/// The derivatives of the prediction, one column for each parameter, by steps that change it by about the noise. A
/// simulated prediction jumps when a stop appears. A small jump counts by its effect within the noise; the difference
/// does not cross a larger jump right beside p, nor a bound.
std::optional<Eigen::MatrixXd> derivative(const Prediction& model, const Eigen::VectorXd& p, const FitScale& scale,
                                          double noise);

/// Variances of the parameters for noise of variance 1, and undetermined ("silent") parameters.
struct Covariance {
    Eigen::MatrixXd matrix;
    std::vector<bool> silent;
    std::vector<bool> open;  ///< whether the error exceeds half of the prior one, so that it is practically unbounded
    double log_volume = 0;   ///< log of the square root of the determinant, in units of `whole`
};
/// The prior error of a parameter, in units of `whole`.
inline constexpr double widest_error = 10;
/// Computes the covariance from the derivatives J. As prior knowledge each parameter has an error of ten times `whole`,
/// which bounds the errors along flat valleys; all parameters that change along such a valley are silent.
Covariance covariance_of(Eigen::MatrixXd J, const Eigen::VectorXd& whole, double noise);

/// The number of samples that count as one independent sample: 1 for white noise, more if neighbours are correlated
/// (Sokal's sum, up to the first insignificant lag).
double correlation_length(std::span<const double> residual);

}  // namespace dinal::analysis
