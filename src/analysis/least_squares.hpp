// Levenberg and Marquardt's method for a model that is run: derivatives by differences, bounds by projection.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

namespace dinal::analysis {

/// What the model says for these parameters; none where it has nothing to say.
using Prediction = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters)>;

struct LeastSquares {
    Eigen::VectorXd parameters, residual;  ///< residual: measured less predicted
    double sum = 0;                        ///< of squares
};

struct FitScale {
    Eigen::VectorXd typical;  ///< of each parameter, where it is 0
    Eigen::VectorXd least;    ///< of each parameter
};

/// From a start to the nearest least sum of squares; none when the model says nothing there.
std::optional<LeastSquares> least_squares(const Prediction& model, const Eigen::VectorXd& measured,
                                          const Eigen::VectorXd& start, const FitScale& scale, int most_steps);

/// The derivatives of the first rows of the prediction, a column a parameter: central differences, one-sided at a
/// bound.
std::optional<Eigen::MatrixXd> derivative(const Prediction& model, const Eigen::VectorXd& p, const FitScale& scale,
                                          Eigen::Index rows);

/// Variances of the parameters for noise of variance 1, and those that say nothing (their variance is 0).
struct Covariance {
    Eigen::MatrixXd matrix;
    std::vector<bool> silent;
};
Covariance covariance_of(const Eigen::VectorXd& p, Eigen::MatrixXd J, const FitScale& scale);

}  // namespace dinal::analysis
