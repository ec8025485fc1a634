// Torques that a model may lack, and what they would do to its motion.
//
// To first order the motion changes by the sum of the responses to such torques. Of one body with a linear spring and
// Coulomb's friction a response obeys a linear equation between the events of the motion; at a turn, a stop and a start
// it jumps as the velocity there does. So it is computed without a run. Of every other system it is the difference of
// two runs.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>

#include "model/excitation.hpp"
#include "motion/run.hpp"

namespace dinal::analysis {

/// Torques of one size that depend on the velocity, then on theta: one after another, in this order.
inline constexpr Eigen::Index velocity_torques = 5, theta_torques = 3;

class MissingTorques {
public:
    using Row = Eigen::Matrix<double, 1, velocity_torques + theta_torques>;

    /// Along a motion with these angles and velocities.
    MissingTorques(std::span<const double> theta, std::span<const double> velocity);
    /// `way` is the sign of the velocity, at a turn that before or after it, and 0 for a mass that stands.
    [[nodiscard]] Row at(double theta, double velocity, double way) const;
    /// A row for each of these places.
    [[nodiscard]] Eigen::MatrixXd along(std::span<const double> theta, std::span<const double> velocity) const;

private:
    double far_, fast_;
};

/// How the angles of this run change with each of the torques, a column each. Requires a linear spring, Coulomb's
/// friction, an M without feedback, and a row of the run for each of these times.
Eigen::MatrixXd responses(const model::Oscillator& system, const model::Excitation& M, const motion::Run& run,
                          std::span<const double> times);

/// A prediction with this torque added to M; none if nothing can be predicted.
using Pushed = std::function<std::optional<Eigen::VectorXd>(const model::Excitation& added)>;
/// How the prediction changes with each of these torques, by steps of about the noise; `whole` is a large torque.
std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, std::span<const double> times,
                                         const Eigen::MatrixXd& torques, double whole, double noise);

}  // namespace dinal::analysis
