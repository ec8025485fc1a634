// What a wrong model leaves in the residual of a fit: a pattern that depends on theta, on velocity or on time.
//
// A term that the model lacks pushes the motion by a torque that depends on theta or velocity. To first order the
// residual is then a sum of the responses to such torques. The responses are regressors beside the derivatives by the
// fitted parameters (the score test of Lagrange multipliers), so what the parameters can imitate counts for nothing. A
// zero that drifts adds slow cosines of time to the record. Noise with a memory is no misfit: residual and regressors
// are filtered until the residual is white, and slow cosines are compared with those that are a little faster.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "model/excitation.hpp"

namespace dinal::analysis {

enum class Follows { velocity, theta, time };
inline constexpr std::array<std::string_view, 3> follows_names{"velocity", "theta", "time"};

/// Torques of one size along a motion that a model may lack, a column each; a number for each time.
Eigen::MatrixXd missing_torques(Follows what, std::span<const double> theta, std::span<const double> velocity);

/// A prediction with this torque added to M; none if nothing can be predicted.
using Pushed = std::function<std::optional<Eigen::VectorXd>(const model::Excitation& added)>;
/// How the prediction changes with each of these torques, by steps of about the noise; `whole` is a large torque.
std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, std::span<const double> times,
                                         const Eigen::MatrixXd& torques, double whole, double noise);

/// Regressors that belong together.
struct Structure {
    Follows what;
    Eigen::MatrixXd columns;  ///< changes of the prediction
    Eigen::MatrixXd faster;   ///< cosines that the first are compared with; none: compared with all of the residual
};
/// A slow drift of the numbers in `column`.
Structure drift(std::span<const double> times, std::span<const int> columns, int column);

struct Misfit {
    Follows what = Follows::velocity;
    bool is_sure = false;        ///< chance makes such a one in some ten thousands of records
    double share = 0;            ///< of the sum of squares of the residual, which the structure explains
    double noise = 0;            ///< standard deviation of the residual without the structure
    Eigen::VectorXd shift;       ///< of the parameters, when the structure is taken out
    Eigen::MatrixXd covariance;  ///< of the parameters then

    /// The shift is known to first order only: it counts as an error of one standard deviation.
    [[nodiscard]] Eigen::MatrixXd added_covariance() const { return covariance + shift * shift.transpose(); }
    /// Beyond a third of the residual first order says too little about the parameters.
    [[nodiscard]] bool leaves_errors() const { return share < 1.0 / 3; }
};

/// The structure that explains most of the residual, first of those that are sure; none if chance would make one of
/// them in some dozens of records. `slopes` are the derivatives by the parameters, `columns` the measured column of
/// each number.
std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole,
                                std::span<const Structure> structures);

/// By which factors the errors of the parameters grow, beyond `widening`, because noise with a memory of one step has
/// more of the slow changes that some of them depend on.
Eigen::VectorXd widened_by_memory(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole,
                                  const Eigen::VectorXd& residual, std::span<const int> columns, double noise,
                                  double widening);

/// Whether the correlation of neighbours is within that many standard deviations of chance.
bool is_white(std::span<const double> residual, double unusual = 2);
/// Whether slow cosines of time stand out: a small drift moves a fitted zero by far more than it colours the residual.
bool may_drift(std::span<const double> times, std::span<const double> residual);
/// A residual that is white once the memory of one step is filtered out.
bool has_only_memory(std::span<const double> residual);

/// The smallest difference of two neighbours that differ: the step of an instrument that shows steps.
double smallest_step(std::span<const double> values);

}  // namespace dinal::analysis
