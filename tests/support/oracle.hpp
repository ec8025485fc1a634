// A second opinion on any motion: Boost.odeint's Fehlberg 7(8) in long double, with events and stick and slip of its
// own.
//
// Nothing of src/core is used but the names of its types; what M is and where it jumps it is told anew.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "motion/simulate.hpp"
#include "support/closed_form.hpp"

namespace dinal::truth {

/// M as the oracle sees it: stretches of time between breaks, smooth in each.
struct Load {
    /// M at t by the formulas that hold at the time `inside`, so that both ends of a stretch can be asked; less what
    /// friction has beside its constant, 0 at velocity 0.
    std::function<real(real t, real inside, const Motion&)> torque;
    std::vector<double> breaks = {};  ///< increasing
    double quickest = 0;              ///< rad per time unit of the fastest oscillation in it
};

struct OracleEvent {
    real t = 0;
    model::EventKind kind = model::EventKind::turn;
    real theta = 0;
    /// How fast what decides about t passes zero, in natural units: theta''/(w0^2 size), or M'/(w0 k size) of a slip.
    real sharpness = 0;
};

class Oracle {
public:
    /// `size` is about the greatest angle to expect; `times`, increasing, are those at which the motion is wanted.
    /// `tolerance` is what a step may be wrong by, over size. A run has some hundred steps: at 1e-16, which long double
    /// still tells from rounding, 1e-13 of the size is certain.
    Oracle(const model::Oscillator& system, Load load, const model::State& initial, const motion::Window& window,
           double size, std::vector<double> times, real tolerance = 1e-16L);

    [[nodiscard]] const std::vector<OracleEvent>& events() const { return events_; }
    /// The motion at `times`.
    [[nodiscard]] const std::vector<Motion>& motions() const { return motions_; }
    /// By how little any decision was taken, in natural units: a velocity that did not quite come down to zero, a load
    /// near Re at a standstill, a release that just did or did not come about, a standstill near a break.
    [[nodiscard]] real narrowest() const { return narrowest_; }
    /// max(|theta|, |velocity|/w0) over the run.
    [[nodiscard]] real largest() const { return largest_; }
    /// The motion went beyond all bounds, or would have taken too long: an unstable feedback.
    [[nodiscard]] bool gave_up() const { return gave_up_; }

private:
    using Point = std::array<real, 2>;  // theta/size, velocity/(w0 size)
    struct Stretch {
        real from, to, inside;
    };
    struct Step {
        Point begin;
        real from, length;  // in radians since the stretch began
        Point end;
    };

    void pass(const Stretch& stretch);
    void move(const Stretch& stretch);
    void wait(const Stretch& stretch);
    [[nodiscard]] bool look_for_standstill(const Stretch& stretch, const Step& step);
    void stand_still(const Stretch& stretch, const Step& step, real length);
    void slope(const Stretch& stretch, const Point& y, Point& dy, real tau) const;
    [[nodiscard]] Point part_of(const Stretch& stretch, const Step& step, real length) const;
    [[nodiscard]] real torque(const Stretch& stretch, real t, const Motion& y) const;
    [[nodiscard]] int from_standstill(const Stretch& stretch);
    void note(model::EventKind kind, real sharpness);
    void tell_until(const Stretch& stretch, const Step& step, real length);
    void close_call(real margin);

    const model::Oscillator& system_;
    Load load_;
    using Sides = std::array<real, 2>;  // of a friction that is constant each way: backward, forward
    [[nodiscard]] static real of(const Sides& sides, int sign) { return sides[sign > 0 ? 1 : 0]; }
    [[nodiscard]] bool dry() const { return Re_[0] > 0 || Re_[1] > 0; }

    real size_, k_, w0_;
    Sides Re_, Rd_;
    real t_start_, t_end_;
    real longest_;  // step, radians
    real tolerance_;
    std::vector<double> times_;

    real t_;
    Point y_;
    int sign_ = 0;  // 0: stuck, or (without friction) not yet moved
    long steps_ = 0;
    std::vector<OracleEvent> events_;
    std::vector<Motion> motions_;
    real narrowest_ = 1, largest_ = 0;
    bool gave_up_ = false;
};

}  // namespace dinal::truth
