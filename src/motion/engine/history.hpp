// The motion of a run between its rows, stretch by stretch: evaluated at any time, integrated for its energy, and read
// by delayed terms.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "model/system.hpp"
#include "motion/clock.hpp"
#include "motion/course.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/mechanics.hpp"
#include "motion/engine/nodes.hpp"
#include "text/not_copied.hpp"

namespace dinal::motion::engine {

/// A stretch of one body that is recomputed when it is evaluated.
class Remade : text::NotCopied {
public:
    virtual ~Remade() = default;
    /// Returns angle and velocity at this time after the start of the stretch.
    virtual std::vector<double> at(double since_start) const = 0;
    /// Returns the work as a function of the time after the start. The function must not outlive the stretch.
    [[nodiscard]] virtual std::function<Work(double)> works() const = 0;
    virtual std::size_t bytes() const = 0;
};

/// The stored data of a stretch, or of its beginning if an event ended it there.
struct Kept {
    Clock start;
    double h = 0;       ///< half of the solved length
    double length = 0;  ///< length used, at most 2 h
    struct Value {
        double begin = 0;
        Series change{};  ///< value minus `begin`
    };
    std::vector<Value> y{};  ///< each angle, velocity and state
    /// The torques at a joint, at the nodes. For a body's joint with the ground they include M and the inertial
    /// torque of the base.
    struct JointTorques {
        Nodes M{}, friction{};                  ///< torques on its angle
        std::unique_ptr<Nodes> push{}, belt{};  ///< null without base or belt
        std::unique_ptr<Nodes> springs{};       ///< torque of sticking sliders and pressed walls, which store energy
        bool presses = false;                   ///< whether an elastic wall is pressed, so that its damping acts
        double slides = 0;                      ///< torque of sliding sliders
        bool holds = false;                     ///< whether friction holds without slip
    };
    std::vector<JointTorques> acting{};
    std::shared_ptr<const Remade> remade{};  ///< replaces changes and torques

    double value(std::size_t k, double x) const {
        return x <= -1 ? y[k].begin : y[k].begin + cheb::value(y[k].change, std::min(x, 1.0));
    }
    double x(double t) const { return start.until(t) / h - 1; }
};

/// The energy at the joints over a stretch, or over an instantaneous change.
class JointLeg {
public:
    virtual ~JointLeg() = default;
    virtual double length() const = 0;
    virtual double since_start(double t) const = 0;
    /// The work at a joint from the start to `since_start`; the work of M and the base on a body counts at its joint
    /// with the ground.
    virtual Work work(std::size_t joint, double since_start) const = 0;
};

class History {
public:
    /// Uses only weights, damping and walls of the joints; joint i < bodies is that of body i with the ground. `before`
    /// is the past of a continued run, `most` the memory limit in bytes.
    History(std::vector<model::Joint> joints, std::size_t bodies, std::vector<double> initial, double t_start,
            std::shared_ptr<const History> before, std::size_t most)
        : joints_(std::move(joints)),
          bodies_(bodies),
          initial_(std::move(initial)),
          t_start_(t_start),
          before_(std::move(before)),
          most_(most) {}

    /// Stores a stretch permanently while memory lasts. Stretches that end after the time `past` are stored in any
    /// case.
    void add(Kept kept, bool for_good, double past);
    /// Stores an instantaneous energy change: a user's action or an impact.
    void add_jump(double t, std::size_t joint, const Work& work) { jumps_.push_back({list_.size(), t, joint, work}); }
    /// Stores the state at the end of the run, including instantaneous changes there.
    void close(const Clock& end, const std::vector<double>& y);

    /// Returns all angles, velocities and states at a time of the run.
    std::vector<double> at(double t) const { return at(t, Side::at); }
    std::vector<double> at(double t, Side side) const;
    std::size_t bytes() const { return bytes_; }
    /// Returns the time up to which the motion is stored, including earlier runs; infinite if all of it is.
    double whole_until() const {
        return before_ == nullptr ? whole_until_ : std::min(whole_until_, before_->whole_until());
    }
    /// The end times of the stored stretches.
    std::vector<double> ends() const;
    /// Visits all legs in order without gaps. Requires a run that keeps torques.
    void legs(const std::function<void(const JointLeg&)>& visit) const;
    /// The same, including earlier runs if this one began after `start`.
    void legs_since(double start, const std::function<void(const JointLeg&)>& visit) const;

private:
    struct Jump {
        std::size_t stretch;  // index of the stretch after it
        double t;
        std::size_t joint;
        Work work;
    };
    std::vector<model::Joint> joints_;
    std::size_t bodies_;
    std::vector<double> initial_;
    double t_start_;
    std::shared_ptr<const History> before_;
    std::size_t most_, bytes_ = 0;
    double whole_until_ = std::numeric_limits<double>::infinity();
    std::vector<Kept> list_;
    std::size_t for_good_ = 0;  ///< length of the permanent part of the list
    std::vector<Jump> jumps_;
};

/// The state that a continued run needs.
struct Carry {
    std::vector<double> y;
    std::vector<double> low;  ///< rounding errors of the angles; may be empty
    Mode mode;
    std::vector<std::vector<Signal::Memory>> controllers;  ///< memory of the loads of each body
    std::vector<Watch> watches;                            ///< state of the user's events; may be empty
    std::vector<std::pair<double, int>> echoes;            ///< breaks that delays repeat
    std::vector<model::Motion> heading;                    ///< directions without dry friction; may be empty
    std::shared_ptr<const History> past;
    double born = 0;   ///< start of the first of these runs
    Floor floor = {};  ///< may be empty
};

/// What a finished run keeps for views of single bodies and links, and for continuing it.
struct Left {
    std::vector<double> start = {};  ///< all angles, velocities and states at the start
    Mode begun = {};                 ///< mode of the contacts at the start
    std::shared_ptr<const History> history = {};
    std::shared_ptr<const Carry> carry = {};

    /// Returns whether the motion between the rows was kept. A run of no duration counts as kept.
    bool is_dense(const Run& run) const {
        return history != nullptr && (history->bytes() > 0 || run.t_stop == run.t_start);
    }
};

}  // namespace dinal::motion::engine
