// Levenberg and Marquardt's method for a model that is run: derivatives by differences, bounds by projection.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace dinal::analysis {

/// Returns the model's values for these parameters; none if it has none.
using Prediction = std::function<std::optional<Eigen::VectorXd>(const Eigen::VectorXd& parameters)>;

struct LeastSquares {
    Eigen::VectorXd parameters, residual;  ///< residual: measured less predicted
    double sum = 0;                        ///< of squares
};

struct FitScale {
    Eigen::VectorXd typical;  ///< of each parameter, where it is 0
    Eigen::VectorXd least;    ///< of each parameter
    Eigen::VectorXd whole;    ///< an error so great says nothing about the parameter
    Eigen::VectorXd hold;     ///< adds |hold (p - start)|^2 to the sum, so that what nothing depends on stays
};

/// From a start to the nearest least sum of squares; none when the model says nothing there.
std::optional<LeastSquares> least_squares(const Prediction& model, const Eigen::VectorXd& measured,
                                          const Eigen::VectorXd& start, const FitScale& scale, int most_steps);

/// The derivatives of the prediction, a column a parameter, by steps that change it by about the noise. A model that is
/// run jumps where a stop comes about: a small jump counts by what it does within the noise, and one that the parameter
/// stands just before is not looked across, no more than a bound is.
std::optional<Eigen::MatrixXd> derivative(const Prediction& model, const Eigen::VectorXd& p, const FitScale& scale,
                                          double noise);

/// Variances of the parameters for noise of variance 1, and those that the record says nothing about.
struct Covariance {
    Eigen::MatrixXd matrix;
    std::vector<bool> silent;
    std::vector<bool> open;  ///< silent ones that next to nothing bounds
    double log_volume = 0;   ///< ln of the root of the determinant, in units of what says nothing
};
/// Before the record nothing is known to better than ten times what says nothing, which bounds the errors along a
/// valley that is flat; all parameters that such a valley runs through are silent, not one of them.
Covariance covariance_of(Eigen::MatrixXd J, const Eigen::VectorXd& whole, double noise);

/// The number of samples that count as one: 1 for noise, more if neighbours are alike (Sokal's sum, up to the first lag
/// that is noise).
double correlation_length(std::span<const double> residual);

}  // namespace dinal::analysis
