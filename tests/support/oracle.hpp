// A second opinion on any motion: Boost.odeint's Fehlberg 7(8) in long double, with its own events and stick/slip
// logic.
//
// Uses only type names of src; M and its breaks are defined independently.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "motion/simulate.hpp"
#include "support/closed_form.hpp"

namespace dinal::truth {

/// M for the oracle: smooth on each stretch between breaks.
struct Load {
    /// M at t by the formulas valid at the time `inside`, so that both ends of a stretch can be evaluated; minus
    /// friction beyond its constant, which is 0 at velocity 0.
    std::function<real(real t, real inside, const Motion&)> torque;
    std::vector<double> breaks = {};  ///< increasing
    double quickest = 0;              ///< fastest oscillation, rad per time unit
};

struct OracleEvent {
    real t = 0;
    model::EventKind kind = model::EventKind::turn;
    real theta = 0;
    /// Rate at which the quantity that determines t passes zero, in natural units: theta''/(w0^2 size), or M'/(w0 k
    /// size) for a slip.
    real sharpness = 0;
};

class Oracle {
public:
    /// `size`: about the greatest expected angle; `times`: increasing output times; `tolerance`: error of a step over
    /// size. A run has some hundred steps: with 1e-16, which long double still resolves, 1e-13 of the size is certain.
    Oracle(const model::Oscillator& system, Load load, const model::State& initial, const motion::Window& window,
           double size, std::vector<double> times, real tolerance = 1e-16L);

    [[nodiscard]] const std::vector<OracleEvent>& events() const { return events_; }
    /// The motion at `times`.
    [[nodiscard]] const std::vector<Motion>& motions() const { return motions_; }
    /// The smallest margin of any decision, in natural units: a velocity that nearly reached zero, a load near Re at a
    /// standstill, a release that barely did or did not occur, a standstill near a break.
    [[nodiscard]] real narrowest() const { return narrowest_; }
    /// max(|theta|, |velocity|/w0) over the run.
    [[nodiscard]] real largest() const { return largest_; }
    /// Returns whether the motion diverged or would have taken too long, as under an unstable feedback.
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
    using Sides = std::array<real, 2>;  // constant friction for each direction: backward, forward
    [[nodiscard]] static real of(const Sides& sides, int sign) { return sides[sign > 0 ? 1 : 0]; }
    [[nodiscard]] bool dry() const { return Re_[0] > 0 || Re_[1] > 0; }

    real size_, k_, w0_;
    Sides Re_, Rd_;
    real t_start_, t_end_;
    real longest_;  // longest step, radians
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
