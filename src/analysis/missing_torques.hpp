// Torques that a model may lack, and the changes of the motion that they would cause.
//
// To first order the motion changes by the sum of the responses to such torques. For one body with a linear spring and
// Coulomb friction, a response obeys a linear equation between events; at a turn, stop or start it jumps like the
// velocity there. So it is computed without a run. For every other system it is the difference of two runs.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "model/excitation.hpp"
#include "motion/run.hpp"

namespace dinal::analysis {

/// The numbers of unit torques that depend on velocity and on theta; they are stored in this order.
inline constexpr Eigen::Index velocity_torques = 5, theta_torques = 3;
/// The first of those velocity torques that are friction which falls with the speed.
inline constexpr Eigen::Index first_falling = 2;
/// The first of those theta torques that a linear spring does not have.
inline constexpr Eigen::Index first_bent = 1;

class MissingTorques {
public:
    using Row = Eigen::Matrix<double, 1, velocity_torques + theta_torques>;

    /// Scales the torques by the greatest angle and velocity of this motion.
    MissingTorques(std::span<const double> theta, std::span<const double> velocity);
    /// `way` is the sign of the velocity, at a turn that before or after it, and 0 for a mass at rest.
    Row at(double theta, double velocity, double way) const;
    /// One row for each state.
    Eigen::MatrixXd along(std::span<const double> theta, std::span<const double> velocity) const;

private:
    double far_, fast_;
};

/// The changes of the run's angles caused by each of the torques, one column for each. Requires a linear spring,
/// Coulomb friction, an M without feedback, and a row of the run at each of these times.
Eigen::MatrixXd responses(const model::Oscillator& system, const model::Excitation& M, const motion::Run& run,
                          std::span<const double> times);

/// A prediction with this torque added to M; empty if it cannot be evaluated.
using Pushed = std::function<std::optional<Eigen::VectorXd>(const model::Excitation& added)>;
/// The changes of the prediction caused by each of these torques, by differences of about the noise; `whole` is a large
/// torque.
std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, std::span<const double> times,
                                         const Eigen::MatrixXd& torques, double whole, double noise);

}  // namespace dinal::analysis
