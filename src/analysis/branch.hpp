// Continuation of steady motions in a parameter by pseudo-arclength (H. B. Keller, 1977): it follows the curve round
// folds, beyond which the motion is unstable.
//
// A point of the branch is a fixed point x of a map at a parameter p: n equations for n + 1 unknowns, plus the
// arclength condition. Bifurcations are zeros of test functions of the map's derivative, located on the branch.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "analysis/steady.hpp"
#include "analysis/steady_facts.hpp"
#include "text/not_copied.hpp"

namespace dinal::analysis {

/// The question at a parameter value; called only between the least and the greatest requested value.
using Family = std::function<SteadyQuestion(double parameter)>;

struct HeldMode;

/// The map whose fixed points are the motions of a branch, at any parameter value.
class Circuit : text::NotCopied {
public:
    struct Lap {
        Eigen::VectorXd to;
        bool finished = false;
        std::optional<Eigen::MatrixXd> derivative = {};  ///< with respect to the place; none: use differences
        MapStep step = {};                               ///< step of a period map
        double time = 0;
        std::shared_ptr<const HeldMode> mode = {};  ///< discrete state at the end, if known
    };

    virtual ~Circuit() = default;

    virtual Lap lap(const Eigen::VectorXd& x, double p) = 0;
    /// The facts about the motion through a fixed point; status none if it cannot be run.
    virtual SteadyMotion motion(const Eigen::VectorXd& x, double p, const Lap& lap,
                                const Eigen::MatrixXd& derivative) = 0;
    /// The scale of each component of a place.
    virtual Eigen::VectorXd units(const Eigen::VectorXd& x, const Lap& lap, const SteadyMotion& motion) const = 0;
    /// The step of differences, in units.
    virtual double difference() const { return 1e-5; }
    /// Moves the section if the motion has drifted away from it, and returns these places in the new coordinates; empty
    /// if no move is needed or possible.
    virtual std::optional<std::vector<Eigen::VectorXd>> recentred(
        const SteadyMotion& /*motion*/, const std::vector<std::pair<Eigen::VectorXd, double>>& /*places*/) {
        return {};
    }

    /// For a limit cycle that begins at a rest: the distance of its first place from the rest.
    virtual Eigen::VectorXd growth() const { return {}; }

    const Eigen::VectorXd& first() const { return first_; }
    /// Returns whether the map covers half a period of a symmetric motion.
    bool is_half() const { return half_; }
    /// Returns whether the motion is a rest of an autonomous system, with multipliers over a fixed time.
    bool stands() const { return stands_; }
    /// Returns whether the motion is a limit cycle, which may shrink to a rest.
    bool cycles() const { return cycles_; }
    const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }
    /// Returns whether no map can be computed any more, because of Ctrl-C or a failure of M.
    bool stopped() const { return stopped_; }

protected:
    void note_outcome(model::Outcome outcome, const std::optional<model::Contradiction>& contradiction) {
        if (contradiction) contradiction_ = contradiction;
        stopped_ = stopped_ || contradiction_ || outcome == model::Outcome::interrupted ||
                   outcome == model::Outcome::excitation_not_finite;
    }

    Eigen::VectorXd first_;
    bool half_ = false, stands_ = false, cycles_ = false;

private:
    bool stopped_ = false;
    std::optional<model::Contradiction> contradiction_;
};

/// A circuit of theta and velocity over `periods` of M, or over half a period if the motion and the whole family are
/// symmetric.
std::unique_ptr<Circuit> circuit_of_periods(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor);
/// A circuit of theta, velocity and states, also over half a period if symmetric: from period to period, from passage
/// to passage of a cycle, or of a steadily sliding rest (return_circuit.cpp). Null if the motion does not contain its
/// full state.
std::unique_ptr<Circuit> circuit_of_returns(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor);

/// A circuit of limit cycles born at a Hopf point of a rest: the first place is on a cycle so small that it is linear.
/// Null if disturbances of the rest do not rotate.
std::unique_ptr<Circuit> circuit_of_first_cycles(const Family& family, double p, const SteadyMotion& rest,
                                                 const motion::Monitor& monitor);

/// The event at a point of a branch. Fold: the branch turns back. Doubling, pitchfork, torus: a motion of twice the
/// period, without symmetry, or with a second frequency begins. Hopf: a limit cycle begins at a rest.
enum class BranchKind { point, fold, doubling, pitchfork, torus, hopf };
constexpr std::string_view name(BranchKind kind) {
    constexpr std::array<std::string_view, 6> names{"point", "fold", "doubling", "pitchfork", "torus", "hopf"};
    return names[static_cast<std::size_t>(kind)];
}

struct BranchPoint {
    double parameter = 0;
    SteadyMotion motion = {};
    bool asked = false;  ///< whether it is at a requested parameter value
    BranchKind kind = BranchKind::point;
};

/// The reason for the end of a walk: end of the range, loss of the branch, a closed curve, a motion that became a rest
/// or unbounded, or an interruption.
enum class WalkEnd { range, lost, closed, vanished, stopped };

struct BranchPath {
    std::vector<BranchPoint> points;  ///< points in order along the branch, without the first one
    WalkEnd end = WalkEnd::range;
};

/// Walks from the circuit's first place at this parameter towards greater (way = 1) or smaller (-1) values. `values`
/// increase, two at least.
BranchPath walk(Circuit& circuit, std::span<const double> values, double parameter, double way);
/// Switches to the branch that begins at this parameter, as at a doubling with a circuit of twice the periods.
BranchPath walk_aside(Circuit& circuit, std::span<const double> values, double parameter);
/// Walks from a limit cycle towards larger ones.
BranchPath walk_up(Circuit& circuit, std::span<const double> values, double parameter);

}  // namespace dinal::analysis
