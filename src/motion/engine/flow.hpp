// The motion of a system on a stretch in one mode: one interface for all methods, and what they have in common.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "motion/engine/mechanics.hpp"
#include "motion/engine/newton.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/noise.hpp"
#include "motion/engine/segment.hpp"
#include "motion/engine/torque_sizes.hpp"
#include "motion/engine/unseen.hpp"
#include "motion/method.hpp"

namespace dinal::motion::engine {

/// A method finds the motion at the nodes of a stretch, and says how well. All that follows from that is the same.
class Flow {
public:
    enum class Attempt { resolved, shorten, failed };
    virtual ~Flow() = default;
    Flow(const Flow&) = delete;
    Flow& operator=(const Flow&) = delete;

    /// From `start` to `end`, 2 h later. Functions of the motion are asked at `departing` at its beginning. failed:
    /// something is not finite at bad_time().
    Attempt solve(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin,
                  const std::vector<double>& departing);
    /// The stretch is used up to a place only: functions are proven there if they were not on the whole of it. Returns
    /// false if one hides something. Not for steps, which prove nothing.
    bool hides_nothing_until(double x, Segment& segment, const Mode& mode);
    [[nodiscard]] double bad_time() const { return bad_time_; }
    /// Over 1: by how much the last one was not resolved.
    [[nodiscard]] double unresolved() const { return unresolved_; }
    /// The factor by which the next stretch may be longer than the last one, which was resolved, if one may.
    [[nodiscard]] double growth() const { return growth_; }
    /// The last one was not resolved because of noise, which need not be smoother from now on.
    bool found_noise(const Segment& segment, const Mode& mode) {
        return noise_.found(segment, mode, tolerance_, sizes_.all, proofs_);
    }
    /// All that acts is known between doubles of the time, too, and no stretch is too short for it.
    [[nodiscard]] bool tells_rests() const {
        return tells_rests_ && !mechanics_.nonlinear() && !mechanics_.has_belts();
    }
    [[nodiscard]] const Noise& noise() const { return noise_; }
    void know(const Floor& floor) { noise_.know(floor); }
    /// The possible error of a body's velocity on a stretch that was resolved.
    [[nodiscard]] double uncertain(std::size_t body, const Segment& segment) const {
        return segment.h * allowed_[body];
    }
    /// Returns the sizes of torques at the beginning of the last one; without loads that depend on the motion.
    [[nodiscard]] const TorqueSizes& sizes_at_start() const { return sizes_.at_start; }
    /// The longest time between two looks at a function of the time in a stretch.
    [[nodiscard]] virtual double gap(const Segment& segment) const;
    /// The time at which a function of the time breaks in the last one; none if none does.
    [[nodiscard]] std::optional<double> found_break(const Segment& segment) const;
    /// The belt of a joint has clearly different velocities before and at this time.
    [[nodiscard]] bool belt_jumps(const Segment& segment, std::size_t joint, double t) const;
    /// The time of an undeclared jump of the belt of a joint in a stretch; none if there is only noise.
    [[nodiscard]] std::optional<double> jump_of_belt(const Segment& segment, std::size_t joint) const;
    /// All stand where they are, for any length of time.
    void stand_still(Segment& segment, const std::vector<double>& y) const;
    /// A stretch too short to matter is a straight line.
    void pass_over(Segment& segment) const;
    /// The possible error of torques that results from the slopes of belts, which are differences.
    [[nodiscard]] double blurred_by_belts(const Segment& segment) const;
    /// The limits of what sticks, where they change.
    void find_limits(Segment& segment, const Mode& mode) const;

protected:
    Flow(const Mechanics& mechanics, double tolerance, double longest);
    /// Finds the accelerations of groups and the rates of states at the nodes, and the motion there.
    virtual Attempt find(Segment& segment, const Mode& mode, const Frame& frame,
                         const std::vector<double>& departing) = 0;
    /// Judges what was found.
    virtual Attempt accept(Segment& segment, const Mode& mode, const Frame& frame) = 0;
    /// The motion at the nodes is the integral of the rates there.
    [[nodiscard]] virtual bool follows_rates() const = 0;

    /// Torques and rates from the node `first` to before `end`; new accelerations of the groups. Functions of the
    /// motion are asked at `departing` where that is given, else at the motion of the segment.
    bool evaluate(Segment& segment, const Mode& mode, const Frame& frame, std::size_t first = 0,
                  std::size_t end = node_count, const std::vector<double>* departing = nullptr);
    void judge(const Segment& segment, const Mode& mode, const Frame& frame);
    Attempt look_between(Segment& segment, const Mode& mode, const Frame& frame);
    void find_sizes(const Segment& segment);

    const Mechanics& mechanics_;
    double tolerance_, longest_;
    std::size_t n_, m_;
    double unresolved_ = 0, growth_ = 1;
    struct {
        std::vector<double> belts, rates;  ///< so far
        double lost_by_belts = 0;          ///< of the velocities of belts on the last stretch, because t is rounded
    } fastest_;
    Noise noise_;
    Newton newton_;
    struct {
        std::vector<Nodes> velocities, rates, ways;
    } offsets_;                           ///< of each body against its group
    std::vector<Nodes> unknown_, found_;  ///< accelerations of the groups and rates, and new ones
    struct {
        std::vector<double> all;
        TorqueSizes at_start;
    } sizes_;  ///< of the torques on each body
    /// Room, so that a stretch need not allocate it.
    struct {
        std::vector<double> torque, load, belt, rate;
        std::vector<Nodes> lacking;
        std::array<std::vector<double>, node_count> points;  ///< all of y at a node
    } room_;

private:
    void make_room(Segment& segment) const;
    void find_holding(Segment& segment, const Mode& mode, const Frame& frame);
    [[nodiscard]] bool is_compared(std::size_t joint, const Mode& mode) const;
    bool sample(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin);
    void fit_series(Segment& segment, const Frame& frame, const std::vector<double>& begin);
    void judge_bodies(const Segment& segment, const Mode& mode, const Frame& frame,
                      const std::vector<double>& by_others);
    void judge_joints(const Segment& segment, const Mode& mode);
    void judge_states(const Segment& segment, const Frame& frame, const std::vector<double>& by_others);
    void note(const Segment& segment, const Series& series, double scale, double allowed);
    [[nodiscard]] double lost_of_loads(const Segment& segment, std::size_t body) const;
    void add_turns(const Segment& segment, std::vector<double>& places) const;
    bool hides_nothing(Segment& segment, const Mode& mode, double until);
    bool agrees_between(const Segment& segment, const Mode& mode, const Frame& frame);
    /// Returns how great the torques on the angle of a joint are, from those on its bodies.
    [[nodiscard]] double size_at(std::size_t joint) const;
    [[nodiscard]] std::vector<double> passed_on(const Segment& segment, const Frame& frame) const;

    bool tells_rests_ = true;  ///< the loads
    double bad_time_ = 0;
    std::vector<double> allowed_;  ///< of each body's acceleration
    Proofs proofs_;
};

/// Noise at single nodes is up to so many times its last coefficients.
inline constexpr double of_tail = 8;

/// Returns the weighted sum of what the groups have that move a body.
template <class Value>
double sum_of_groups(const Frame::Shape& shape, const Value& value) {
    double sum = 0;
    for (const auto& [group, by] : shape) sum += by * value(group);
    return sum;
}

}  // namespace dinal::motion::engine
