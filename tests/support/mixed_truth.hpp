// A second opinion on any run of one body, with states, controllers with a memory, belts, bases, friction laws, walls
// and user events: Fehlberg 7(8) of Boost.odeint in long double with short steps, event by event.
//
// Uses nothing of src. Times, angles, velocities and torques are of order 1.
#pragma once

#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace dinal::truth {

using real = long double;

struct MixedPoint {
    real theta = 0, velocity = 0, z = 0;
};

/// Sliding friction in a direction (-1 or 1) at speeds up to the next corner of the law. Must continue smoothly a
/// little outside of its range.
struct Sliding {
    std::function<real(int way, real speed)> torque;
    real steep = 1;  ///< bounds its slope
    real to = HUGE_VALL;
};
/// Straight lines between torques at speeds; the last torque holds for all greater speeds.
std::vector<Sliding> lines_through(const std::vector<double>& speed, const std::vector<double>& torque);

struct MixedSystem {
    template <class R>
    using F = std::function<R(real t, const MixedPoint&)>;
    real I = 1, C = 0, k = 1;
    std::function<real(real theta)> spring = [](real) -> real { return 0; };
    std::vector<Sliding> sliding;
    std::array<real, 2> holding{};  ///< backward, forward
    F<real> M;                      ///< without controllers
    /// The part of M that jumps or bends at `breaks`: at t, for a step around `inside`. Empty: none.
    std::function<real(real t, real inside, const MixedPoint&)> broken;
    std::vector<real> breaks;
    bool bends = false;  ///< whether M may have corners in theta
    F<real> rate = [](real, const MixedPoint&) -> real { return 0; };
    std::function<real(real)> belt, belt_rate, base;  ///< empty: none
    F<real> sampled;                                  ///< empty: none
    real every = 1, delay = 0;
    F<real> relay_of;  ///< empty: none
    real on = 0, off = 0;
    std::array<real, 2> levels{};
    F<real> delayed;  ///< empty: none
    real by = 1;
    F<real> when;            ///< empty: none; fires on upward zeros
    real kept_velocity = 1;  ///< factor applied to the velocity at that event
    bool walls = false;
    real lower = 0, upper = 0, restitution = 0;
};

struct MixedEvent {
    real t;
    std::string kind;
    real theta;
};

class MixedTruth {
public:
    MixedTruth(MixedSystem system, const MixedPoint& start, real t_end, std::vector<double> times);
    std::vector<MixedEvent> events;
    std::vector<MixedPoint> motions;
    int corners_passed = 0;  ///< corners of the law
    bool doubtful = false;   ///< whether a step contains more than it can resolve, or the motion creeps or diverges

private:
    struct Past {
        real t, length;
        MixedPoint begin, end;
        real a0, a1;
    };
    [[nodiscard]] bool is_dry() const { return s_.holding[0] + s_.holding[1] > 0; }
    [[nodiscard]] real belt(real t) const { return s_.belt ? s_.belt(t) : 0; }
    [[nodiscard]] real slip(real t, const MixedPoint& y) const { return y.velocity - belt(t); }
    [[nodiscard]] real torque(real t, const MixedPoint& y) const;
    [[nodiscard]] real pull(real t, const MixedPoint& y) const;
    [[nodiscard]] MixedPoint slope(real t, const MixedPoint& y) const;
    [[nodiscard]] MixedPoint stepped(real from, const MixedPoint& y, real h) const;
    [[nodiscard]] bool is_resolved(real h) const;
    [[nodiscard]] MixedPoint then(real t) const;
    [[nodiscard]] bool happens(real h, int& what) const;
    void happen(int what);
    void settle(bool tell_stick);
    void slide(int way);
    [[nodiscard]] real longest_step() const;
    void take_samples();
    void tell(const char* kind) {
        if (t_ > 0) events.push_back({t_, kind, y_.theta});
    }

    MixedSystem s_;
    real t_ = 0;
    mutable real middle_ = 0;  // middle of the trial step
    real since_ = 0;           // the last break
    MixedPoint y_, start_;
    int way_ = 0;            // direction of sliding; 0: stuck
    std::size_t range_ = 0;  // range of the law
    int wall_ = 0;           // the wall it leans on
    bool on_ = true, fresh_ = false;
    int half_ = 0;
    real output_ = 0;
    long instant_ = 0;
    std::deque<std::pair<real, real>> pending_;
    std::set<real> breaks_;
    std::vector<Past> past_;
};

}  // namespace dinal::truth
