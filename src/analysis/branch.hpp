// A branch of steady motions over a parameter, walked by pseudo-arclength: along the curve itself, so that it goes
// round the folds, on the far side of which the motion is unstable (H. B. Keller, 1977).
//
// A point of the branch is a fixed point x of a map at a parameter p: n equations for n + 1 unknowns, and one more says
// how far along the curve. Bifurcations are zeros of test functions of the map's derivative, located on the branch.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "analysis/steady.hpp"
#include "analysis/steady_facts.hpp"

namespace dinal::analysis {

/// The question at a value of the parameter. Asked only from the least to the greatest of the values asked for.
using Family = std::function<SteadyQuestion(double parameter)>;

struct HeldMode;

/// The map whose fixed points are the motions of a branch, at any value of the parameter.
class Circuit {
public:
    struct Lap {
        Eigen::VectorXd to;
        bool finished = false;
        std::optional<Eigen::MatrixXd> derivative = {};  ///< by the place; none: differences must tell
        MapStep step = {};                               ///< of a period map
        double time = 0;
        std::shared_ptr<const HeldMode> mode = {};  ///< what holds at its end, where that is known
    };

    Circuit() = default;
    Circuit(const Circuit&) = delete;
    Circuit& operator=(const Circuit&) = delete;
    virtual ~Circuit() = default;

    virtual Lap lap(const Eigen::VectorXd& x, double p) = 0;
    /// The facts about the motion through a fixed point; status none if it can not be run.
    virtual SteadyMotion motion(const Eigen::VectorXd& x, double p, const Lap& lap,
                                const Eigen::MatrixXd& derivative) = 0;
    /// How much the motion changes each number of a place.
    [[nodiscard]] virtual Eigen::VectorXd units(const Eigen::VectorXd& x, const Lap& lap,
                                                const SteadyMotion& motion) const = 0;
    /// Of the units: a step for differences.
    [[nodiscard]] virtual double difference() const { return 1e-5; }
    /// The motion has moved away from where its places are looked at: looks at it elsewhere, and says what these places
    /// are there. None if all is well, or if one of them does not lead there.
    virtual std::optional<std::vector<Eigen::VectorXd>> recentred(
        const SteadyMotion& /*motion*/, const std::vector<std::pair<Eigen::VectorXd, double>>& /*places*/) {
        return {};
    }

    /// Of a limit cycle that begins at a rest: how far its first place is from that.
    [[nodiscard]] virtual Eigen::VectorXd growth() const { return {}; }

    [[nodiscard]] const Eigen::VectorXd& first() const { return first_; }
    /// The map is that of half a period, whose opposite the motion repeats.
    [[nodiscard]] bool is_half() const { return half_; }
    /// A rest in a system without a period, whose multipliers are those of a stretch of time.
    [[nodiscard]] bool stands() const { return stands_; }
    /// A limit cycle, which may become a rest.
    [[nodiscard]] bool cycles() const { return cycles_; }
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }
    /// No map can be computed any more: Ctrl-C, or M has failed.
    [[nodiscard]] bool stopped() const { return stopped_; }

protected:
    void see(model::Outcome outcome, const std::optional<model::Contradiction>& contradiction) {
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

/// Of theta and velocity over `periods` of M, or of its half where the motion is symmetric.
std::unique_ptr<Circuit> circuit_of_periods(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor);
/// Of theta, velocity and states: from period to period, from passage to passage of a cycle, or of a rest that slides;
/// in return_circuit.cpp. None where the motion does not say all of its state.
std::unique_ptr<Circuit> circuit_of_returns(const Family& family, double p, const SteadyMotion& motion, int periods,
                                            const motion::Monitor& monitor);

/// The same of the limit cycles that begin at a Hopf point of a rest: its first place is on one so small that it is
/// that of the linearised motion. None if the disturbances of the rest do not rotate.
std::unique_ptr<Circuit> circuit_of_first_cycles(const Family& family, double p, const SteadyMotion& rest,
                                                 const motion::Monitor& monitor);

/// What happens to the motion at a point of the branch: the branch turns back (fold); a motion of twice the period
/// begins (doubling), or one that is not symmetric (pitchfork), or one with a second frequency (torus), or of a rest a
/// limit cycle (hopf).
enum class BranchKind { point, fold, doubling, pitchfork, torus, hopf };
constexpr std::string_view name(BranchKind kind) {
    constexpr std::array<std::string_view, 6> names{"point", "fold", "doubling", "pitchfork", "torus", "hopf"};
    return names[static_cast<std::size_t>(kind)];
}

struct BranchPoint {
    double parameter = 0;
    SteadyMotion motion = {};
    bool asked = false;  ///< at one of the values asked for
    BranchKind kind = BranchKind::point;
};

/// Why a walk came to its end: at an end of the range, where nothing goes on, where it began, where the motion has
/// become a rest or grows without a bound, or by Ctrl-C and the like.
enum class WalkEnd { range, lost, closed, vanished, stopped };

struct BranchPath {
    std::vector<BranchPoint> points;  ///< in their order along the branch, the first one left out
    WalkEnd end = WalkEnd::range;
};

/// From the first place of the circuit at this parameter towards greater ones (way = 1) or smaller ones (-1). `values`
/// of the parameter increase, two at least.
BranchPath walk(Circuit& circuit, std::span<const double> values, double parameter, double way);
/// From there on to the branch that begins beside it, as at a doubling with a circuit of twice the periods.
BranchPath walk_aside(Circuit& circuit, std::span<const double> values, double parameter);
/// From a limit cycle on to greater ones.
BranchPath walk_up(Circuit& circuit, std::span<const double> values, double parameter);

}  // namespace dinal::analysis
