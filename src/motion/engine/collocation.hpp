// A stretch of the motion of a system in one mode, by collocation at Chebyshev points.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <complex>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "algebra/decompositions.hpp"
#include "motion/clock.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/unseen.hpp"

namespace dinal::motion::engine {

/// What a stepper yields, and all else reads: angles, velocities and states over a stretch without a jump.
struct Segment : NodeTimes {
    Clock start;
    double end = 0;                ///< exactly
    bool proven = true;            ///< functions that are read do nothing in it that their series do not
    bool to_the_end = false;       ///< it ends at `end` to the letter, be that a little earlier or later than 2 h
    std::vector<Nodes> y{};        ///< angles, velocities, states at the nodes
    std::vector<Nodes> f{};        ///< their rates: of the angles without meaning
    std::vector<Nodes> moved{};    ///< angles less their first, which have digits that these have not
    std::vector<double> low{};     ///< of each body: what its angle at the beginning has rounded off
    std::vector<Series> series{};  ///< of y, each less its first
    std::vector<Series> rates{};   ///< of f, but for those of the angles
    std::vector<Nodes> loads{};    ///< of each joint: what depends on the time alone
    std::vector<Nodes> driven{};   ///< of each body: all of its load, and the push of the base
    std::vector<Nodes> torques{};  ///< of each body: all but those of what holds
    std::vector<Nodes> belts{}, belt_rates{};  ///< of each joint
    std::vector<Nodes> holding{};              ///< of each joint that holds: the torque on its first body
    /// Of each joint that sticks and whose limits change: what holds it at most, backward and forward.
    std::vector<std::array<Nodes, 2>> limits{};

    [[nodiscard]] double time(double x) const { return x >= 1 ? end : start.after(h * (1 + x)); }
    [[nodiscard]] double at(std::size_t k, double x) const {
        return x >= 1 ? y[k][node_count - 1] : x <= -1 ? y[k][0] : y[k][0] + cheb::value(series[k], x);
    }
    /// All of y.
    void state(double x, std::vector<double>& out) const {
        out.resize(y.size());
        for (std::size_t k = 0; k < y.size(); ++k) out[k] = at(k, x);
    }
    /// At a node, with its y in `out`.
    Moment moment(std::size_t node, std::vector<double>& out) const {
        out.resize(y.size());
        for (std::size_t k = 0; k < y.size(); ++k) out[k] = y[k][node];
        return {times[node], side(node), out};
    }
};

class Collocation {
public:
    enum class Attempt { resolved, shorten, failed };
    /// `step`: the classical Runge-Kutta method instead, each stretch one step.
    Collocation(const Mechanics& mechanics, double tolerance, double longest, double step = 0);

    /// From `start` to `end`, 2 h later. Functions of the motion are asked at `departing` at its beginning. failed:
    /// something is not finite at bad_time().
    Attempt solve(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin,
                  const std::vector<double>& departing);
    [[nodiscard]] double bad_time() const { return bad_time_; }
    /// Over 1: by how much the last one was not resolved.
    [[nodiscard]] double unresolved() const { return unresolved_; }
    /// The factor by which the next stretch may be longer than the last one, which was resolved.
    [[nodiscard]] double growth() const { return growth_; }
    /// The last one was not resolved, nor a longer one, and what acts on a body, or the rate of a state, is as rough on
    /// far shorter stretches, at one place as at another. From now on it need not be smoother than that.
    bool found_noise(const Segment& segment, const Mode& mode);
    /// All that acts is known between doubles of the time, too, and no stretch is too short for it.
    [[nodiscard]] bool tells_rests() const {
        return tells_rests_ && !mechanics_.nonlinear() && !mechanics_.has_belts();
    }
    /// That of the body where it is greatest, torque.
    [[nodiscard]] double noise() const {
        return *std::max_element(floor_.noise.begin(), floor_.noise.begin() + static_cast<std::ptrdiff_t>(n_));
    }
    /// noise(), where it is more than the tolerance would allow beside what has acted.
    [[nodiscard]] double clear_noise() const {
        double most = 0;
        for (std::size_t i = 0; i < n_; ++i) {
            if (floor_.noise[i] > tolerance_ * floor_.greatest[i]) most = std::max(most, floor_.noise[i]);
        }
        return most;
    }
    [[nodiscard]] const Floor& floor() const { return floor_; }
    /// What an earlier run of the same system has found.
    void know(const Floor& floor) {
        if (floor.noise.size() == floor_.noise.size()) floor_ = floor;
    }
    /// What the velocity of a body may be off by on a stretch that was resolved.
    [[nodiscard]] double uncertain(std::size_t body, const Segment& segment) const {
        return segment.h * allowed_[body];
    }
    /// The longest time between two looks at a function of the time in a stretch.
    [[nodiscard]] double gap(const Segment& segment) const;
    /// Where a function of the time breaks in the last one; none when none does.
    [[nodiscard]] std::optional<double> found_break(const Segment& segment) const;
    /// The belt of a joint has clearly different velocities before and at this time.
    [[nodiscard]] bool belt_jumps(const Segment& segment, std::size_t joint, double t) const;
    /// Where the belt of a joint jumps in a stretch, and does not say so; none where that is noise.
    [[nodiscard]] std::optional<double> jump_of_belt(const Segment& segment, std::size_t joint) const;
    /// All stand where they are, for any length of time.
    void stand_still(Segment& segment, const std::vector<double>& y) const;
    /// A stretch too short to matter is a straight line.
    void pass_over(Segment& segment) const;
    /// What torques may be off by because the slopes of belts are differences.
    [[nodiscard]] double blurred_by_belts(const Segment& segment) const;
    /// The multipliers of what holds, at the nodes.
    void find_holding(Segment& segment, const Mode& mode, const Frame& frame) const;
    /// The limits of what sticks, where they change.
    void find_limits(Segment& segment, const Mode& mode) const;

private:
    static constexpr std::size_t inner = node_count - 1;
    static void multiply(const double* matrix, const double* vector, std::size_t columns, double* product);
    static void integrate(const Nodes& values, double h, Nodes& sums);
    void make_room(Segment& segment) const;
    bool sample(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& begin);
    bool evaluate(Segment& segment, const Mode& mode, const Frame& frame, std::size_t first, std::size_t end,
                  const std::vector<double>* departing);
    void place(Segment& segment, const Frame& frame);
    void guess(Segment& segment, const Frame& frame);
    bool go_on(const Segment& segment, const Frame& frame);
    void remember_end(const Segment& segment, const Frame& frame);
    void fit_series(Segment& segment, const Frame& frame, const std::vector<double>& begin);
    bool find_slopes(const Segment& segment, const Mode& mode, const Frame& frame, std::size_t node);
    /// Newton's matrix for a length. Of a few linear groups it is inverted where it serves many stretches. Of many it
    /// is sparse. Otherwise it falls into one complex matrix, of the groups and states, for each eigenvalue of the
    /// integration, of two conjugate ones for one (Butcher 1976); steps by these are right to ten digits.
    struct Factors {
        int asked = 0;  ///< so often
        Eigen::MatrixXd inverse;
        std::unique_ptr<const algebra::Factored> sparse;
        std::vector<std::complex<double>> of_modes;  ///< their inverses, column after column
        void solve(const Eigen::VectorXd& right, Eigen::VectorXd& left) const;
    };
    const Factors& newton_matrix(double h, const Frame& frame);
    Attempt runge_kutta(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing);
    Attempt iterate(Segment& segment, const Mode& mode, const Frame& frame, const std::vector<double>& departing);
    void judge(const Segment& segment, const Mode& mode, const Frame& frame);
    void add_turns(const Segment& segment, std::vector<double>& places) const;
    bool agrees_between(const Segment& segment, const Mode& mode, const Frame& frame);
    bool hides_nothing(Segment& segment, const Mode& mode);
    std::vector<double> roundings(const Segment& segment, const Mode& mode);
    void find_sizes_at_start(const Segment& segment, const std::vector<double>& begin);
    void find_sizes(const Segment& segment);
    /// Returns how great the torques on the angle of a joint are, from those on its bodies.
    [[nodiscard]] double size_at(std::size_t joint) const;
    /// What acts on a body, or the rate of a state.
    [[nodiscard]] const Nodes& acting(const Segment& segment, std::size_t of) const {
        return of < n_ ? segment.torques[of] : segment.f[n_ + of];
    }
    [[nodiscard]] std::vector<double> passed_on(const Segment& segment, const Frame& frame) const;

    const Mechanics& mechanics_;
    double tolerance_, longest_, step_length_;
    std::size_t n_, m_;
    bool tells_rests_ = true;  ///< the loads
    double bad_time_ = 0, unresolved_ = 0, growth_ = 1;
    double lost_by_belts_ = 0;  ///< of the velocities of belts on the last stretch, because t is rounded
    std::vector<double> fastest_belt_, fastest_rate_;
    std::vector<double> allowed_;  ///< of each body's acceleration
    Floor floor_;
    struct Stalled {
        double from = -model::never, h = 0, tail = 0;
    };
    std::vector<Stalled> stalled_;    ///< of each body and state: the last stretch that it made too long
    std::vector<char> may_be_rough_;  ///< of the same: a function acts
    double seen_ = -model::never;     ///< where a load did what its series does not: looked at until it is behind
    Unseen unseen_;
    int unproven_in_a_row_ = 0;                             ///< stretches
    std::vector<Nodes> offset_, offset_rate_, offset_way_;  ///< of each body against its group
    std::vector<Nodes> unknown_, found_;                    ///< accelerations of the groups and rates, and new ones
    std::vector<Nodes> of_groups_;                          ///< what the velocities of the groups change by
    std::array<std::vector<double>, node_count> points_;    ///< all of y at a node
    /// Of the last stretch: its end, and there each of the unknowns with its first three derivatives.
    struct {
        double t = -model::never, h = 0;
        std::vector<Frame::Shape> groups{};
        std::vector<std::array<double, 4>> unknowns{};
    } end_;
    std::vector<double> torque_, load_, belt_, rate_, scales_;
    std::vector<char> placed_;
    Eigen::MatrixXd slopes_;
    std::vector<Frame::Shape> slopes_of_;  ///< the shapes of bodies for which slopes_ was computed
    std::vector<int> slopes_pressed_;      ///< which elastic walls were pressed then
    std::vector<model::Motion> slopes_sliding_;
    bool slopes_known_ = false;
    std::map<double, Factors> factors_;
    std::pair<const double, Factors>* last_factors_ = nullptr;
    std::vector<double> sizes_, sizes_at_start_;  ///< of each body: how great the torques on it are
    Eigen::VectorXd residual_, step_;
};

}  // namespace dinal::motion::engine
