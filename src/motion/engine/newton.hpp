// Newton's method for the equations of a stretch, and the integration of values at its nodes.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <complex>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "algebra/decompositions.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/noise.hpp"
#include "motion/engine/segment.hpp"

namespace dinal::motion::engine {

/// The number of nodes without the first one.
inline constexpr std::size_t inner = node_count - 1;
/// Integrates values at the nodes from the first node to each of the others.
void integrate(const Nodes& values, double h, Nodes& sums);

/// Holds the Jacobian of accelerations and rates, and solves for a Newton step. Does not change the motion.
class Newton {
public:
    explicit Newton(const Mechanics& mechanics) : mechanics_(mechanics) {}

    /// Begins a stretch: slopes found for other groups, pressed walls or sliders are discarded.
    void begin(const Mode& mode, const Frame& frame);
    bool known() const { return known_; }
    void forget() { known_ = false; }
    /// Computes the derivatives of accelerations and rates with respect to angles, velocities and states at a node.
    /// Returns false if a value is not finite.
    bool find(const Segment& segment, const Mode& mode, const Frame& frame, std::size_t node, const Floor& floor);
    void solve(double h, const Frame& frame, const Eigen::VectorXd& residual, Eigen::VectorXd& step) {
        factors(h, frame).solve(residual, step);
    }
    /// Returns whether the system is linear and the inverse of Newton's matrix is accurate to rounding, so that one
    /// step is exact.
    bool knows_inverse(const Segment& segment, const Mode& mode, const Frame& frame, const Floor& floor) {
        return (known_ || find(segment, mode, frame, 0, floor)) && factors(segment.h, frame).off > 0;
    }
    /// The relative error of the last step because its length differs by rounding from that of the matrix.
    double error_of_length(double h) const {
        return std::fabs(last_factors_->first - h) / h * last_factors_->second.off;
    }
    /// Returns the derivatives; null if they belong to another frame.
    const Eigen::MatrixXd* slopes(const Frame& frame) const {
        const auto rows = static_cast<Eigen::Index>(frame.groups() + mechanics_.states());
        return of_ == frame.bodies && slopes_.rows() == rows ? &slopes_ : nullptr;
    }

private:
    /// Newton's matrix for one length. For a few linear groups that many stretches use, it is inverted. Otherwise it
    /// splits into one complex matrix for each eigenvalue of the integration (Butcher 1976; one of each conjugate
    /// pair), and steps are accurate to ten digits. For a chain, and for very many unknowns, these matrices are banded
    /// in the order of `order`.
    struct Factors {
        int uses = 0;  ///< number of uses
        Eigen::MatrixXd inverse;
        /// bound of the relative change of the matrix with h, if the inverse is accurate to rounding; otherwise 0
        double off = 0;
        /// inverses in column-major order, or L and U by rows, for each eigenvalue
        std::vector<std::complex<double>> of_modes;
        Eigen::Index band = -1;           ///< half band width of L and U; -1: inverses
        std::vector<Eigen::Index> order;  ///< order of the unknowns in L and U
        void solve(const Eigen::VectorXd& rhs, Eigen::VectorXd& solution) const;
    };
    void find_linear(const Frame& frame);
    const Factors& factors(double h, const Frame& frame);
    void find_order(Eigen::Index groups);
    bool factor_band(double h, Eigen::Index groups, Factors& made) const;
    void factor_modes(double h, Eigen::Index groups, Factors& made) const;

    const Mechanics& mechanics_;
    Eigen::MatrixXd slopes_;
    std::vector<Frame::Shape> of_;  ///< shapes of the bodies for which slopes_ was computed
    std::vector<int> pressed_;      ///< elastic walls that were pressed then
    std::vector<model::Motion> sliding_;
    bool known_ = false;
    std::vector<Eigen::Index> order_;  ///< order of the unknowns that keeps neighbours close
    Eigen::Index band_ = 0;            ///< half band width in this order
    std::map<double, Factors> factors_;
    std::pair<const double, Factors>* last_factors_ = nullptr;
};

}  // namespace dinal::motion::engine
