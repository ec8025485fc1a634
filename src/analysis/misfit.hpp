// Detects a wrong model by patterns in the residual of a fit that depend on theta, on velocity or on time.
//
// To first order the residual is then a sum of the responses to missing torques (missing_torques.hpp), or of slow
// functions of time if the zero drifts. Each of these terms is tried as a regressor besides the derivatives with
// respect to the fitted parameters (the score test of Lagrange multipliers), so that effects which the parameters can
// imitate do not count. A term that is possible but not certain is a nuisance: the errors include the shift it would
// cause. Correlated noise is not a misfit: residual and regressors are filtered until the residual is white, and slow
// functions are compared with slightly faster ones.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/noise_memory.hpp"

namespace dinal::analysis {

enum class Follows { velocity, theta, time };
inline constexpr std::array<std::string_view, 3> follows_names{"velocity", "theta", "time"};

/// Regressors that belong to one cause.
struct Structure {
    Follows what;
    Eigen::MatrixXd columns;  ///< changes of the prediction
    Eigen::MatrixXd faster;   ///< regressors for comparison with the first; empty: compared with the whole residual
};
/// A slow drift of the numbers in `column`. If the residual is white, there are no faster regressors for comparison.
Structure drift(std::span<const double> times, std::span<const int> columns, int column, bool is_white);

struct Misfit {
    std::vector<Follows> follows;  ///< what explains the residual best, then all that explains it about as well
    bool is_sure = false;          ///< whether chance would produce it in less than one of a hundred records
    double share = 0;              ///< fraction of the residual's sum of squares that the terms of the first explain
    double noise = 0;              ///< standard deviation of the residual without them
    Eigen::VectorXd shift = {};    ///< change of the parameters when they are added to the model

    /// The parameters are not corrected, so their error includes the whole shift, multiplied by the root of 2 as a
    /// margin.
    Eigen::MatrixXd added_covariance() const { return 2 * shift * shift.transpose(); }
    /// Returns whether errors remain meaningful: beyond a third of the residual the first-order estimate says too
    /// little about the parameters.
    bool leaves_errors() const { return share < 1.0 / 3; }
};

struct NoiseKind {
    bool is_white = true;    ///< without memory
    bool is_uneven = false;  ///< stronger in some parts of the record than in others
};

/// The most significant structure; empty if all may be noise. `slopes` are the derivatives with respect to the
/// parameters, `columns` the measured column of each number.
std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, const NoiseKind& noise, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, std::span<const Structure> structures);

/// What a term that the fit leaves out, with a coefficient of the prior error `size`, does to the parameters.
struct Nuisance {
    Eigen::VectorXd shift;       ///< their change if the term is fitted, too
    Eigen::MatrixXd covariance;  ///< that of such a fit, in units of noise squared
};
Nuisance nuisance(const Eigen::VectorXd& term, double size, const Eigen::VectorXd& residual, const NoiseMemory& memory,
                  const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole, double noise);

/// Returns whether the autocorrelation (up to 40 lags, by Ljung and Box) is within `unusual` standard deviations of
/// chance.
bool is_white(std::span<const double> residual, double unusual = 2);

/// The smallest nonzero difference of two neighbours.
double smallest_step(std::span<const double> values);
/// The smallest step if all values are whole multiples of it apart, as those of a digital instrument or printed
/// numbers; otherwise 0.
double step_of_instrument(std::span<const double> values);
/// Adds to a covariance in units of noise squared the effect of a digital instrument with this step on the reading of
/// `path`: its errors are equal as long as the motion stays within one step, unless noise hides the steps (estimated by
/// the first harmonic of the sawtooth).
void add_steps(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& path, double step, double noise,
               Eigen::MatrixXd& covariance);

}  // namespace dinal::analysis
