// The motion of a run between its rows, stretch by stretch: evaluated anywhere, integrated for its energy, and the past
// of what acts with a delay.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "model/system.hpp"
#include "motion/clock.hpp"
#include "motion/course.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

/// What is kept of a stretch, or of its beginning when an event ended it there.
struct Kept {
    Clock start;
    double h = 0;       ///< half of its length
    double length = 0;  ///< how much of it was used, at most 2 h
    std::vector<double> begin{};
    std::vector<Series> series{};  ///< of each angle, velocity and state, less its first
    /// What acts at a joint, at the nodes. Those of the bodies with the ground have M and the push of the base on their
    /// body, too.
    struct Acting {
        Nodes M{}, friction{};                  ///< torques on its angle
        std::unique_ptr<Nodes> push{}, belt{};  ///< none where there is no base, or no belt
        std::unique_ptr<Nodes> springs{};       ///< what sliders that stick, and pressed walls, take and store
        bool presses = false;                   ///< an elastic wall, whose damping acts
        double slides = 0;                      ///< what sliders take that slide
        bool holds = false;                     ///< friction does not slip
    };
    std::vector<Acting> acting{};

    [[nodiscard]] double value(std::size_t k, double x) const {
        return x <= -1 ? begin[k] : begin[k] + cheb::value(series[k], std::min(x, 1.0));
    }
    [[nodiscard]] double x(double t) const { return start.until(t) / h - 1; }
};

/// A stretch, or what took no time, seen for the energy at its joints.
class JointLeg {
public:
    virtual ~JointLeg() = default;
    [[nodiscard]] virtual double length() const = 0;
    [[nodiscard]] virtual double since_start(double t) const = 0;
    /// The work at a joint until then; of M and of the base, that on its first body, at its joint with the ground.
    [[nodiscard]] virtual Work work(std::size_t joint, double since_start) const = 0;
};

class History {
public:
    /// Only the weights, damping and walls of the joints count; each body's with the ground is in its place. `before`
    /// is the past of a run that goes on, `most` what may be kept, bytes.
    History(std::vector<model::Joint> joints, std::size_t bodies, std::vector<double> initial, double t_start,
            std::shared_ptr<const History> before, std::size_t most)
        : joints_(std::move(joints)),
          bodies_(bodies),
          initial_(std::move(initial)),
          t_start_(t_start),
          before_(std::move(before)),
          most_(most) {}

    /// Keeps a stretch for good while the memory lasts. Stretches later than the time `past` are kept in any case.
    void add(Kept kept, bool for_good, double past);
    /// What took no time: what a user did to the motion, an impact.
    void add_jump(double t, std::size_t joint, const Work& work) { jumps_.push_back({list_.size(), t, joint, work}); }
    /// Where the run has ended: what took no time then counts from there on.
    void close(const Clock& end, std::vector<double> y);

    /// All angles, velocities and states at a time of the run.
    [[nodiscard]] std::vector<double> at(double t) const { return at(t, Side::at); }
    [[nodiscard]] std::vector<double> at(double t, Side side) const;
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// The motion was kept up to this time, with that of the run before; `never` when that is all of it.
    [[nodiscard]] double whole_until() const {
        return before_ == nullptr ? whole_until_ : std::min(whole_until_, before_->whole_until());
    }
    [[nodiscard]] bool empty() const { return list_.empty(); }
    /// When each stretch ended that is kept.
    [[nodiscard]] std::vector<double> ends() const;
    /// In order and without gaps. Only for a run that keeps torques.
    void legs(const std::function<void(const JointLeg&)>& told) const;
    /// Those of the run before, too, if it began at `start` or later.
    void legs_since(double start, const std::function<void(const JointLeg&)>& told) const;

private:
    struct Jump {
        std::size_t stretch;  // the one that comes after it
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
    std::size_t for_good_ = 0;  ///< so many of the list are kept for good, the first ones
    std::vector<Jump> jumps_;
};

}  // namespace dinal::motion::engine
