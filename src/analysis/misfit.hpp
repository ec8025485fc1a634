// What a wrong model leaves in the residual of a fit: a pattern that depends on theta, on velocity or on time.
//
// To first order the residual is then a sum of the responses to torques that the model lacks (missing_torques.hpp), or
// of slow functions of time if the zero drifts. Each of these terms is tried as a regressor beside the derivatives by
// the fitted parameters (the score test of Lagrange multipliers), so what the parameters can imitate counts for
// nothing. One that is possible but not sure is a nuisance: the errors contain how far it would move the parameters.
// Noise with a memory is no misfit: residual and regressors are filtered until the residual is white, and slow
// functions are compared with those that are a little faster.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string_view>

namespace dinal::analysis {

enum class Follows { velocity, theta, time };
inline constexpr std::array<std::string_view, 3> follows_names{"velocity", "theta", "time"};

/// Regressors that belong together.
struct Structure {
    Follows what;
    Eigen::MatrixXd columns;  ///< changes of the prediction
    Eigen::MatrixXd faster;   ///< those that the first are compared with; none: compared with all of the residual
};
/// A slow drift of the numbers in `column`; of a white residual there is nothing faster to compare with.
Structure drift(std::span<const double> times, std::span<const int> columns, int column, bool is_white);

struct Misfit {
    Follows what = Follows::velocity;
    bool is_sure = false;        ///< chance makes such a one in less than one of a hundred records
    double share = 0;            ///< of the sum of squares of the residual, which its terms explain
    double noise = 0;            ///< standard deviation of the residual without them
    Eigen::VectorXd shift = {};  ///< of the parameters, when they are added to the model

    /// As the values stay where they are they err by all of the shift: that it is not just at the end of a standard
    /// error, it counts by the root of 2.
    [[nodiscard]] Eigen::MatrixXd added_covariance() const { return 2 * shift * shift.transpose(); }
    /// Beyond a third of the residual first order says too little about the parameters.
    [[nodiscard]] bool leaves_errors() const { return share < 1.0 / 3; }
};

/// The structure that stands out most; none if all of them are as likely noise. `slopes` are the derivatives by the
/// parameters, `columns` the measured column of each number.
std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, bool is_white, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, std::span<const Structure> structures);

/// By which factors the errors of the parameters grow, beyond `widening`, because noise with a memory of one step has
/// more of the slow changes that some of them depend on.
Eigen::VectorXd widened_by_memory(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole,
                                  const Eigen::VectorXd& residual, std::span<const int> columns, double noise,
                                  double widening);

/// Whether the correlation of neighbours is within that many standard deviations of chance.
bool is_white(std::span<const double> residual, double unusual = 2);
/// A residual that is white once the memory of one step is filtered out.
bool has_only_memory(std::span<const double> residual);

/// The smallest difference of two neighbours that differ.
double smallest_step(std::span<const double> values);
/// That, if all values are whole numbers of it apart, as an instrument with steps or printed digits have it; otherwise
/// 0.
double step_of_instrument(std::span<const double> values);

}  // namespace dinal::analysis
