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

/// The number of nodes but the first one.
inline constexpr std::size_t inner = node_count - 1;
/// Integrates values from the first node to each.
void integrate(const Nodes& values, double h, Nodes& sums);

/// Knows how accelerations and rates depend on the motion, and solves with that for a step. It moves nothing.
class Newton {
public:
    explicit Newton(const Mechanics& mechanics) : mechanics_(mechanics) {}

    /// Begins with a stretch: slopes of other groups, pressed walls or sliders do not serve.
    void begin(const Mode& mode, const Frame& frame);
    [[nodiscard]] bool known() const { return known_; }
    void forget() { known_ = false; }
    /// Finds how accelerations of the groups and rates depend on angles and velocities of the groups and on states, at
    /// a node. Returns false if something is not finite.
    bool find(const Segment& segment, const Mode& mode, const Frame& frame, std::size_t node, const Floor& floor);
    void solve(double h, const Frame& frame, const Eigen::VectorXd& residual, Eigen::VectorXd& step) {
        factors(h, frame).solve(residual, step);
    }
    /// Returns whether all is linear, and the inverse of the matrix is known so well that one step by it is exact for
    /// its own length.
    bool knows_inverse(const Segment& segment, const Mode& mode, const Frame& frame, const Floor& floor) {
        return (known_ || find(segment, mode, frame, 0, floor)) && factors(segment.h, frame).off > 0;
    }
    /// The part of the last step that may be wrong because its length differs from that of the matrix by rounding.
    [[nodiscard]] double error_of_length(double h) const {
        return std::fabs(last_factors_->first - h) / h * last_factors_->second.off;
    }
    /// Returns the slopes; null if they are those of another frame.
    [[nodiscard]] const Eigen::MatrixXd* slopes(const Frame& frame) const {
        const auto rows = static_cast<Eigen::Index>(frame.groups() + mechanics_.states());
        return of_ == frame.bodies && slopes_.rows() == rows ? &slopes_ : nullptr;
    }

private:
    /// Newton's matrix for a length. Of a few linear groups it is inverted where it serves many stretches. Otherwise it
    /// falls into one complex matrix, of the groups and states, for each eigenvalue of the integration, of two
    /// conjugate ones for one (Butcher 1976); steps by these are right to ten digits. In a chain each of them has a
    /// band, in the order that the Newton object has; of very many unknowns without a band the whole matrix is sparse.
    struct Factors {
        int asked = 0;  ///< so often
        Eigen::MatrixXd inverse;
        double off = 0;  ///< the size of the matrix without the unit one, if the inverse is right to rounding
        std::unique_ptr<const algebra::Factored> sparse;
        std::vector<std::complex<double>> of_modes;  ///< their inverses, column after column; or L and U, by rows
        Eigen::Index band = -1;                      ///< of L and U, on either side of the diagonal; -1: inverses
        std::vector<Eigen::Index> order;             ///< of the unknowns in L and U
        void solve(const Eigen::VectorXd& right, Eigen::VectorXd& left) const;
    };
    void find_linear(const Frame& frame);
    const Factors& factors(double h, const Frame& frame);
    void find_order(Eigen::Index groups);
    bool factor_band(double h, Eigen::Index groups, Factors& made) const;
    void factor_modes(double h, Eigen::Index groups, Factors& made) const;

    const Mechanics& mechanics_;
    Eigen::MatrixXd slopes_;
    std::vector<Frame::Shape> of_;  ///< the shapes of bodies for which they were found
    std::vector<int> pressed_;      ///< the elastic walls that were pressed then
    std::vector<model::Motion> sliding_;
    bool known_ = false;
    std::vector<Eigen::Index> order_;  ///< of the unknowns, in which neighbours are near each other
    Eigen::Index band_ = 0;            ///< the greatest distance of neighbours
    std::map<double, Factors> factors_;
    std::pair<const double, Factors>* last_factors_ = nullptr;
};

}  // namespace dinal::motion::engine
