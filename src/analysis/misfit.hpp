// Detects a wrong model by patterns in the residual of a fit that depend on theta, on velocity or on time.
//
// To first order the residual is then a sum of the responses to torques that the model may lack, or of slow
// functions of time if the zero drifts. Each of these terms is tried as a regressor besides the derivatives with
// respect to the fitted parameters (the score test of Lagrange multipliers), so that effects which the parameters can
// imitate do not count. A term that is possible but not certain is a nuisance: the errors include the shift it would
// cause. Correlated noise is not a misfit: residual and regressors are filtered until the residual is white, and slow
// functions are compared with slightly faster ones.
//
// For one body with a linear spring and Coulomb friction, a response obeys a linear equation between events; at a turn,
// stop or start it jumps like the velocity there. So it is computed without a run. For every other system it is the
// difference of two runs.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "analysis/noise_memory.hpp"
#include "model/excitation.hpp"
#include "motion/run.hpp"

namespace dinal::analysis {

/// The numbers of unit torques that depend on velocity and on theta; they are stored in this order.
inline constexpr Eigen::Index velocity_torques = 5, theta_torques = 3;
/// The first of those velocity torques that are friction which falls with the speed.
inline constexpr Eigen::Index first_falling = 2;
/// The first of those theta torques that a linear spring does not have.
inline constexpr Eigen::Index first_bent = 1;

/// How large a torque may be that a model lacks: standard deviations of its coefficient, 0: certainly none. Friction
/// that falls with the speed is a torque against the motion, so its coefficient has one sign.
struct Plausible {
    Eigen::VectorXd sizes = {};
    bool has_sign = false;  ///< whether the coefficient cannot be positive
};
/// Friction that falls by about `Rd`, or a spring that differs from a straight line by about `bend`.
Plausible plausible_friction(double Rd);
Plausible plausible_spring(double bend);

class MissingTorques {
public:
    using Row = Eigen::Matrix<double, 1, velocity_torques + theta_torques>;

    /// Scales the torques by the greatest angle and velocity of this motion.
    MissingTorques(std::span<const double> theta, std::span<const double> velocity);
    /// `way` is the sign of the velocity, at a turn that before or after it, and 0 for a mass at rest.
    Row at(double theta, double velocity, double way) const;
    /// The torques along a motion with these samples: also between them and at both sides of each turn, where they
    /// jump.
    struct Path {
        std::vector<double> t = {};
        std::vector<Row> torques = {};
    };
    Path along(std::span<const double> times, std::span<const double> theta, std::span<const double> velocity) const;

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
std::optional<Eigen::MatrixXd> responses(const Pushed& pushed, const MissingTorques::Path& path, double whole,
                                         double noise);

enum class Follows { velocity, theta, time };
inline constexpr std::array<std::string_view, 3> follows_names{"velocity", "theta", "time"};

/// Regressors that belong to one cause.
struct Structure {
    Follows what;
    Eigen::MatrixXd columns;  ///< changes of the prediction
    Eigen::MatrixXd faster;   ///< regressors for comparison with the first; empty: compared with the whole residual
    Plausible plausible = {};
};
/// A slow drift of the numbers in `column`. If the residual is white, there are no faster regressors for comparison.
Structure drift(std::span<const double> times, std::span<const int> columns, int column, bool is_white);

struct Misfit {
    std::vector<Follows> follows;  ///< the best explanation of the residual, then those that are about as good
    bool is_sure = false;          ///< whether chance would produce it in less than one of a hundred records
    double share = 0;            ///< fraction of the residual's sum of squares that the terms of the first one explain
    double noise = 0;            ///< standard deviation of the residual without these terms
    Eigen::VectorXd shift = {};  ///< change of the parameters when they are added to the model

    /// The parameters are not corrected, so their error includes the whole shift, multiplied by the root of 2 as a
    /// margin.
    Eigen::MatrixXd added_covariance() const { return 2 * shift * shift.transpose(); }
    /// Returns whether errors remain meaningful: beyond a third of the residual the first-order estimate says too
    /// little about the parameters.
    bool leaves_errors() const { return share < 1.0 / 3; }
};

struct NoiseKind {
    bool is_white = true;    ///< whether it has no memory
    bool is_uneven = false;  ///< whether it is stronger in some parts of the record
};

/// The most significant structure; empty if all may be noise. `slopes` are the derivatives with respect to the
/// parameters, `columns` the measured column of each number.
std::optional<Misfit> misfit_of(const Eigen::VectorXd& residual, const NoiseKind& noise, std::span<const int> columns,
                                const Eigen::MatrixXd& slopes, std::span<const Structure> structures);

/// The effect on the parameters of a term that the fit leaves out, whose coefficient has the prior error `size`.
struct Nuisance {
    Eigen::VectorXd shift;       ///< change of the parameters if the term is also fitted
    Eigen::MatrixXd covariance;  ///< covariance of such a fit, in units of noise squared
};
Nuisance nuisance(const Eigen::VectorXd& term, double size, const Eigen::VectorXd& residual, const NoiseMemory& memory,
                  const Eigen::MatrixXd& slopes, const Eigen::VectorXd& whole, double noise);

/// What torques that the model lacks add to the covariance of the parameters, in squares of their units. It is the mean
/// over models: as likely as the fitted one, before the record is seen, is one with each of the plausible torques.
Eigen::MatrixXd unseen_covariance(std::span<const Structure> structures, const Eigen::VectorXd& residual,
                                  const NoiseMemory& memory, const Eigen::MatrixXd& slopes,
                                  const Eigen::VectorXd& whole, double noise);

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
