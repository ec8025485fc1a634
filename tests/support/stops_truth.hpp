// A second opinion on springs of any kind, and on walls: Boost.odeint's Fehlberg 7(8) in long double, from event to
// event, with stick and slip, impacts and rest against a wall of its own.
//
// Nothing of src is used but the names of events. All is in units in which angles, velocities and torques are about 1.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "model/event.hpp"
#include "support/closed_form.hpp"

namespace dinal::truth {

struct TrueWalls {
    real lower, upper, restitution;
};

struct StopsSystem {
    real I = 1, C = 0, k = 1;
    std::function<real(real theta)> spring = [](real) -> real { return 0; };  ///< besides k theta
    std::array<real, 2> Rd{}, Re{};  ///< of a motion, a pull: backward, forward
    std::function<real(real t, const Motion&)> M = [](real, const Motion&) -> real { return 0; };
    std::optional<TrueWalls> walls = {};
    real quickest = 1;  ///< rad per time unit of the fastest thing in it
};

struct StopsEvent {
    real t = 0;
    model::EventKind kind = model::EventKind::turn;
    real theta = 0;
    real velocity = 0;  ///< of an impact: with which it came
};

class StopsTruth {
public:
    /// `tolerance` is what a step may be wrong by, as a part of the way that it goes.
    StopsTruth(StopsSystem system, const Motion& initial, real t_start, real t_end, std::vector<double> times,
               real tolerance = 1e-15L);

    [[nodiscard]] const std::vector<StopsEvent>& events() const { return events_; }
    [[nodiscard]] const std::vector<Motion>& motions() const { return motions_; }
    [[nodiscard]] real largest() const { return largest_; }
    [[nodiscard]] bool gave_up() const { return gave_up_; }

private:
    using Point = std::array<real, 2>;  // theta less the origin, velocity
    enum class Mode { moving, stuck, leaning };

    void begin();
    void move();
    void stand();
    bool find_event(const Point& from, real h);
    void arrive(real theta_off);
    void hit(int side, real velocity);
    void lean(int side, real after);
    void settle(bool from_motion);
    [[nodiscard]] bool dry() const { return s_.Re[0] > 0 || s_.Re[1] > 0; }
    [[nodiscard]] real torque(real t, const Point& y) const;
    [[nodiscard]] real pull(real t) const;
    [[nodiscard]] Point stepped(const Point& y, real t, real h) const;
    [[nodiscard]] real acceleration(real t, const Point& y) const;
    [[nodiscard]] real wall_off(int side) const { return (side > 0 ? s_.walls->upper : s_.walls->lower) - origin_; }
    void tell(model::EventKind kind, real velocity = 0);
    void tell_rows(const Point& from, real until);

    StopsSystem s_;
    real t_, t_start_, t_end_, tolerance_;
    std::vector<double> times_;
    Point y_;
    real origin_ = 0;  // a wall, after it was hit: what comes near it keeps its digits
    int sign_ = 0;     // of the sliding
    int side_ = 0;     // of the wall that the mass leans against
    Mode mode_ = Mode::moving;
    std::vector<StopsEvent> events_;
    std::vector<Motion> motions_;
    real largest_ = 0;
    long steps_ = 0;
    bool gave_up_ = false;
};

}  // namespace dinal::truth
