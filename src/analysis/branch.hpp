// A branch of steady motions over a parameter, walked by pseudo-arclength: along the curve itself, so that it goes
// round the folds, on the far side of which the motion is unstable (H. B. Keller, 1977).
//
// A point of the branch is a fixed point x of the period map (of its half, where everything repeats the other way
// round) at a parameter p: two equations for three unknowns, and a third one says how far along the curve.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "analysis/steady.hpp"
#include "analysis/steady_facts.hpp"

namespace dinal::analysis {

/// The question at a value of the parameter. Asked only from the least to the greatest of the values asked for.
using Family = std::function<SteadyQuestion(double parameter)>;

struct BranchPoint {
    double parameter = 0;
    SteadyMotion motion = {};
    bool asked = false;  ///< at one of the values asked for
    bool fold = false;   ///< here the branch turns back
};

/// Why a walk came to its end: at an end of the range, where nothing goes on, where it began, or by Ctrl-C and the
/// like.
enum class WalkEnd { range, lost, closed, stopped };

struct BranchPath {
    std::vector<BranchPoint> points;  ///< in their order along the branch, the first one left out
    WalkEnd end = WalkEnd::range;
};

class BranchWalk {
public:
    /// `values` of the parameter increase, two at least; all must outlive it.
    BranchWalk(const Family& family, std::span<const double> values, const motion::Monitor& monitor)
        : family_(family),
          values_(values),
          monitor_(monitor),
          range_(values.back() - values.front()),
          slack_(1e-12 * range_) {}

    /// From a steady motion at this parameter towards greater ones (way = 1) or smaller ones (-1).
    BranchPath walk(double parameter, const SteadyMotion& from, double way);

    /// What was found of a function that is none.
    [[nodiscard]] const std::optional<model::Contradiction>& contradiction() const { return contradiction_; }
    /// No map can be computed any more: Ctrl-C, or M has failed.
    [[nodiscard]] bool stopped() const { return stopped_; }

private:
    using Vector3 = Eigen::Vector3d;
    using Slopes = Eigen::Matrix<double, 2, 3>;  // of what a fixed point misses, by x and p

    /// A fixed point with the slopes there.
    struct Spot {
        Place x = Place::Zero();
        double p = 0;
        FixedPointSearch::Try found = {};
        Slopes slopes = Slopes::Zero();
        SteadyMotion motion = {};
    };

    [[nodiscard]] Vector3 scaled(const Spot& spot) const {
        return {spot.x[0] / size_, spot.x[1] / size_, spot.p / range_};
    }
    /// Slopes as the scaled unknowns and the scaled miss have them.
    [[nodiscard]] Slopes scaled(const Slopes& slopes) const {
        return slopes * Vector3(size_, size_, range_).asDiagonal() / size_;
    }
    /// The way on along the curve, of length 1, not against `before`.
    [[nodiscard]] Vector3 tangent(const Spot& spot, const Vector3& before) const;

    FixedPointSearch::Try look(const Place& x, double p, std::optional<SteadyQuestion>* asked = nullptr);
    void differentiate(Spot& spot);
    /// The point of the curve nearest to a guess, in the plane through the guess across `normal`.
    std::optional<Spot> correct(const Vector3& guess, const Vector3& normal, Slopes slopes);
    std::optional<Spot> at_value(const Spot& a, const Spot& b, double p);
    /// Between two points with the p of the tangent changing its sign: where that is zero.
    std::optional<Spot> fold_between(const Spot& a, const Spot& b, const Vector3& from);
    /// The next one asked for, or the end of the range.
    [[nodiscard]] double next_value(double p, double way) const;
    /// Adds the points at the values between two points and, unless it lies beyond the range, the second one; whether
    /// the branch goes on inside it.
    bool add_way(const Spot& a, const Spot& b, bool fold);
    void add(const Spot& spot, bool fold);
    /// The one asked for that this is, but for rounding; else itself.
    [[nodiscard]] double value_near(double p) const;

    const Family& family_;
    std::span<const double> values_;
    const motion::Monitor& monitor_;
    double range_, slack_;
    double size_ = 1;  // of the motion here: the unit of x
    double sign_ = 1;  // -1 of a half period
    int periods_ = 1;
    bool half_ = false;
    BranchPath path_;
    bool stopped_ = false;
    std::optional<model::Contradiction> contradiction_;
};

}  // namespace dinal::analysis
