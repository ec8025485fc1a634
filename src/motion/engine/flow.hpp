// Computes the motion of a system over one stretch in one mode. This is the interface of all methods, and their common
// part.
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

/// A method computes the motion at the nodes of a stretch and estimates its error. The rest is common to all methods.
class Flow {
public:
    enum class Attempt { resolved, shorten, failed };
    virtual ~Flow() = default;
    Flow(const Flow&) = delete;
    Flow& operator=(const Flow&) = delete;

    /// Computes the motion from `start` to `end` = start + 2 h. At the start, functions of the motion are evaluated at
    /// `departing`. The result is `failed` if a value is not finite, at bad_time().
    Attempt solve(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin,
                  const std::vector<double>& departing);
    /// Proves, for a stretch that is used up to the point x only, that functions follow their series there. Returns
    /// false if one does not. Runge-Kutta steps are not proven.
    bool hides_nothing_until(double x, Segment& segment, const Mode& mode);
    /// Returns whether an acceleration or a rate is so much greater beyond the point x that the error of the stretch,
    /// which is relative to the greatest one, may matter before x.
    [[nodiscard]] bool is_dwarfed_beyond(double x, const Segment& segment) const;
    [[nodiscard]] double bad_time() const { return bad_time_; }
    /// Returns whether the last attempt failed because its iteration reached a motion that is not finite, as the
    /// formula of a piece may cause beyond its end.
    [[nodiscard]] bool strayed() const { return strayed_; }
    /// The error of the last stretch over the allowed one, scaled as if of order 16; at most 1 if it is resolved.
    [[nodiscard]] double unresolved() const { return unresolved_; }
    /// The factor by which the next stretch may be longer than the last resolved one.
    [[nodiscard]] double growth() const { return growth_; }
    /// Returns whether the last stretch was unresolved because of noise, which is tolerated from now on.
    bool found_noise(const Segment& segment, const Mode& mode) {
        return noise_.found(segment, mode, tolerance_, sizes_.all, proofs_);
    }
    /// Returns whether all loads can be evaluated between two doubles of the time, so that no stretch is too short.
    [[nodiscard]] bool takes_rests() const {
        return takes_rests_ && !mechanics_.nonlinear() && !mechanics_.has_belts();
    }
    [[nodiscard]] const Noise& noise() const { return noise_; }
    /// Returns the noise of the torques on a stretch; the share of a sliding load adds the rounding of the greatest
    /// torque.
    [[nodiscard]] double noise_of_torques(const Segment& segment) const;
    void start_with(const Floor& floor) { noise_.start_with(floor); }
    /// The possible error of a body's velocity at the end of a resolved stretch.
    [[nodiscard]] double uncertain(std::size_t body, const Segment& segment) const {
        return segment.h * allowed_[body];
    }
    /// Returns the magnitudes of torques at the start of the last stretch, without loads that depend on the motion.
    [[nodiscard]] const TorqueSizes& sizes_at_start() const { return sizes_.at_start; }
    /// The longest time between two samples of a function of time in a stretch.
    [[nodiscard]] virtual double gap(const Segment& segment) const;
    /// The time of a break of a function of time in the last stretch; empty if there is none.
    [[nodiscard]] std::optional<double> found_break(const Segment& segment) const;
    /// Returns whether the belt of a joint clearly jumps at this time.
    [[nodiscard]] bool belt_jumps(const Segment& segment, std::size_t joint, double t) const;
    /// Returns the time of an undeclared jump of a joint's belt in a stretch; empty if there is only noise.
    [[nodiscard]] std::optional<double> jump_of_belt(const Segment& segment, std::size_t joint) const;
    /// Lets everything stand still over the stretch, however long it is.
    void stand_still(Segment& segment, const std::vector<double>& y) const;
    /// Extrapolates the motion linearly over a stretch that is too short to matter.
    void pass_over(Segment& segment) const;
    /// The possible error of torques due to the numerical slopes of belts.
    [[nodiscard]] double blurred_by_belts(const Segment& segment) const;
    /// Returns the possible error of a velocity over a stretch due to the rounding of belt velocities, whose slopes it
    /// integrates.
    [[nodiscard]] double blurred_velocity() const;
    /// Computes the holding limits of sticking joints if they vary.
    void find_limits(Segment& segment, const Mode& mode) const;

protected:
    Flow(const Mechanics& mechanics, double tolerance, double longest);
    /// Computes the accelerations of groups, the rates of states and the motion at the nodes.
    virtual Attempt find(Segment& segment, const Mode& mode, const Frame& frame,
                         const std::vector<double>& departing) = 0;
    /// Checks the error of the result.
    virtual Attempt accept(Segment& segment, const Mode& mode, const Frame& frame) = 0;
    /// Returns whether the motion at the nodes is the integral of the rates there.
    [[nodiscard]] virtual bool follows_rates() const = 0;

    /// Computes torques and rates at the nodes from `first` up to but excluding `end`, and the accelerations of the
    /// groups. Functions of the motion are evaluated at the state `departing` at the first node, if given, otherwise at
    /// the motion of the segment.
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
        std::vector<double> belts, rates;  ///< greatest magnitudes so far
        double lost_by_belts = 0;          ///< error of belt velocities on the last stretch due to the rounding of t
    } fastest_;
    Noise noise_;
    Newton newton_;
    struct {
        std::vector<Nodes> velocities, rates, ways;
    } offsets_;  ///< motion of each body relative to its groups
    /// accelerations of the groups and rates of the states, and their recomputed values
    std::vector<Nodes> unknown_, found_;
    bool strayed_ = false;
    struct {
        std::vector<double> all;
        TorqueSizes at_start;
    } sizes_;  ///< magnitude of the torques on each body
    /// Storage that is reused, to avoid allocation in each stretch.
    struct {
        std::vector<double> torque, load, belt, rate;
        std::vector<Nodes> lacking;
        std::array<std::vector<double>, node_count> points;  ///< the state y at each node
    } room_;

private:
    void make_room(Segment& segment) const;
    void find_holding(Segment& segment, const Mode& mode, const Frame& frame);
    [[nodiscard]] bool is_compared(std::size_t joint, const Mode& mode) const;
    void note_rates_until(double end, const Segment& segment);
    bool sample(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin);
    void fit_series(Segment& segment, const Frame& frame, const std::vector<double>& begin);
    void judge_bodies(const Segment& segment, const Mode& mode, const Frame& frame,
                      const std::vector<double>& by_others);
    void judge_joints(const Segment& segment, const Mode& mode);
    void judge_states(const Segment& segment, const Frame& frame, const std::vector<double>& by_others);
    void note_error(const Segment& segment, const Series& series, double scale, double allowed);
    [[nodiscard]] double lost_by_belt(const Segment& segment, std::size_t joint, const Series& belt);
    [[nodiscard]] double lost_of_torques(const Segment& segment, std::size_t body) const;
    void add_turns(const Segment& segment, std::vector<double>& places) const;
    bool hides_nothing(Segment& segment, const Mode& mode, double until);
    bool agrees_between(const Segment& segment, const Mode& mode, const Frame& frame);
    /// Returns the magnitude of the torques on the angle of a joint, from those on its bodies.
    [[nodiscard]] double size_at(std::size_t joint) const;
    [[nodiscard]] std::vector<double> passed_on(const Segment& segment, const Frame& frame) const;

    bool takes_rests_ = true;  ///< whether all loads can be evaluated between two doubles of the time
    double bad_time_ = 0;
    std::vector<double> allowed_;  ///< allowed error of each body's acceleration
    Proofs proofs_;
};

/// The ratio of noise at single nodes to the last coefficients.
inline constexpr double of_tail = 8;

/// Returns the weighted sum over the groups that move a body.
template <class Value>
double sum_of_groups(const Frame::Shape& shape, const Value& value) {
    double sum = 0;
    for (const auto& [group, by] : shape) sum += by * value(group);
    return sum;
}

}  // namespace dinal::motion::engine
