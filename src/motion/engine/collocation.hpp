// A stretch of the motion of a system in one mode, by collocation at Chebyshev points.
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
#include "motion/engine/unseen.hpp"
#include "motion/method.hpp"

namespace dinal::motion::engine {

class Collocation {
public:
    enum class Attempt { resolved, shorten, failed };
    /// `step`: the classical Runge-Kutta method instead, each stretch one step. `pair`: a step of this one.
    Collocation(const Mechanics& mechanics, double tolerance, double longest, double step = 0,
                const Pair* pair = nullptr);

    /// From `start` to `end`, 2 h later. Functions of the motion are asked at `departing` at its beginning. failed:
    /// something is not finite at bad_time().
    Attempt solve(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin,
                  const std::vector<double>& departing);
    /// The stretch is used up to a place only: functions are proven there if they were not on the whole of it. Returns
    /// false if one hides something.
    bool hides_nothing_until(double x, Segment& segment, const Mode& mode);
    [[nodiscard]] double bad_time() const { return bad_time_; }
    /// Over 1: by how much the last one was not resolved.
    [[nodiscard]] double unresolved() const { return unresolved_; }
    /// The factor by which the next stretch may be longer than the last one, which was resolved.
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
    /// The longest time between two looks at a function of the time in a stretch.
    [[nodiscard]] double gap(const Segment& segment) const;
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
    /// The multipliers of what holds, at the nodes.
    void find_holding(Segment& segment, const Mode& mode, const Frame& frame) const;
    /// The limits of what sticks, where they change.
    void find_limits(Segment& segment, const Mode& mode) const;

private:
    [[nodiscard]] bool hides_nothing(Segment& segment, const Mode& mode, double until);
    void make_room(Segment& segment) const;
    bool sample(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin);
    bool evaluate(Segment& segment, const Mode& mode, const Frame& frame, std::size_t first, std::size_t end,
                  const std::vector<double>* departing);
    void place(Segment& segment, const Frame& frame);
    void guess(Segment& segment, const Frame& frame);
    bool go_on(const Segment& segment, const Frame& frame);
    void remember_end(const Segment& segment, const Frame& frame);
    void fit_series(Segment& segment, const Frame& frame, const std::vector<double>& begin);
    Attempt runge_kutta(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing);
    template <class Rates>
    bool find_stages(Segment& segment, const Rates& rates, std::vector<double>& change);
    [[nodiscard]] double error_of_step(const Segment& segment, const Frame& frame) const;
    enum class Slopes { known, here, none };
    Attempt iterate(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing);
    Attempt iterate(Segment& segment, const Mode& mode, const Frame& frame, Slopes slopes);
    void begin_at_first_node(Segment& segment, const Frame& frame);
    struct Residual {
        double left = 0;        ///< over of the equations
        double stalls = 1e-12;  ///< a change so small is noise
    };
    Residual find_residual(const Segment& segment, const Frame& frame);
    double take_step(double h);
    void judge(const Segment& segment, const Mode& mode, const Frame& frame);
    void judge_bodies(const Segment& segment, const Frame& frame, const std::vector<double>& by_others);
    void judge_joints(const Segment& segment, const Mode& mode);
    void judge_states(const Segment& segment, const Frame& frame, const std::vector<double>& by_others);
    void note(const Series& series, double scale, double allowed);
    [[nodiscard]] double lost_of_loads(const Segment& segment, std::size_t body) const;
    void add_turns(const Segment& segment, std::vector<double>& places) const;
    bool agrees_between(const Segment& segment, const Mode& mode, const Frame& frame);
    void find_sizes_at_start(const Segment& segment, const std::vector<double>& begin);
    void find_sizes(const Segment& segment);
    /// Returns how great the torques on the angle of a joint are, from those on its bodies.
    [[nodiscard]] double size_at(std::size_t joint) const;
    [[nodiscard]] std::vector<double> passed_on(const Segment& segment, const Frame& frame) const;

    const Mechanics& mechanics_;
    double tolerance_, longest_, step_length_;
    /// The embedded pair of Runge-Kutta methods, and its last step.
    struct {
        const Pair* method;                       ///< null: another method
        std::vector<std::vector<double>> stages;  ///< slopes of the groups and states
        std::vector<double> error, bulge;
    } pair_;
    std::size_t n_, m_;
    bool tells_rests_ = true;  ///< the loads
    double bad_time_ = 0, unresolved_ = 0, growth_ = 1;
    struct {
        std::vector<double> belts, rates;  ///< so far
        double lost_by_belts = 0;          ///< of the velocities of belts on the last stretch, because t is rounded
    } fastest_;
    std::vector<double> allowed_;  ///< of each body's acceleration
    Noise noise_;
    Newton newton_;
    Proofs proofs_;
    struct {
        std::vector<Nodes> velocities, rates, ways;
    } offsets_;                           ///< of each body against its group
    std::vector<Nodes> unknown_, found_;  ///< accelerations of the groups and rates, and new ones
    /// The end of the last stretch, and there each of the unknowns with its first three derivatives.
    struct {
        double t = -model::never, h = 0;
        std::vector<Frame::Shape> groups{};
        std::vector<std::array<double, 4>> unknowns{};
    } end_;
    struct {
        std::vector<double> all, at_start;
    } sizes_;                     ///< of the torques on each body
    std::vector<double> scales_;  ///< the width of the motion of each group and state
    /// Room, so that a stretch need not allocate it.
    struct {
        std::vector<double> torque, load, belt, rate;
        std::vector<char> placed;
        std::vector<Nodes> of_groups;                        ///< the changes of the groups' velocities
        std::array<std::vector<double>, node_count> points;  ///< all of y at a node
    } room_;
    Eigen::VectorXd residual_, step_;
};

}  // namespace dinal::motion::engine
