// A stretch is an interval of smooth motion, integrated as one step; a Segment holds its result.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "motion/clock.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/signal.hpp"

namespace dinal::motion::engine {

/// The motion over a stretch: angles, velocities and states. Written by a Flow, read by everything else.
struct Segment : NodeTimes {
    Clock start;
    double end = 0;  ///< end time, exact
    /// whether formulas are proven to follow their series between the nodes
    bool proven = true;
    bool may_grow = true;          ///< whether the next stretch may be longer
    bool slides = false;           ///< whether a load slides, so that it has the rounding of all torques
    bool to_the_end = false;       ///< whether it ends exactly at `end`, even if 2 h is slightly different
    std::vector<Nodes> y{};        ///< angles, velocities, states at the nodes
    std::vector<Nodes> f{};        ///< rates of y; those of the angles are undefined
    std::vector<Nodes> moved{};    ///< angles minus the first, more accurate than the difference of y
    std::vector<double> low{};     ///< rounding error of each body's angle at the start
    std::vector<Series> series{};  ///< series of y minus its first value
    std::vector<Series> rates{};   ///< series of f, except those of the angles
    std::vector<Nodes> loads{};    ///< time-only part of each joint's load
    std::vector<Nodes> driven{};   ///< for each joint: its whole load, for a body with the inertial torque of the base
    std::vector<Nodes> torques{};  ///< for each body: all torques except those of sticking joints
    std::vector<Nodes> belts{}, belt_rates{};  ///< velocity and acceleration of each joint's belt
    std::vector<Nodes> holding{};              ///< torque of each sticking joint on its first body
    std::vector<Series> holding_series{};      ///< the same as series, if the torque is compared with a limit
    /// The holding limits of each sticking joint whose limits vary, backward and forward.
    std::vector<std::array<Nodes, 2>> limits{};

    double time(double x) const { return x >= 1 ? end : start.after(h * (1 + x)); }
    double at(std::size_t k, double x) const {
        return x >= 1 ? y[k][node_count - 1] : x <= -1 ? y[k][0] : y[k][0] + cheb::value(series[k], x);
    }
    /// Stores all of y at the point x in `out`.
    void state(double x, std::vector<double>& out) const {
        out.resize(y.size());
        for (std::size_t k = 0; k < y.size(); ++k) out[k] = at(k, x);
    }
    /// The moment at a node, with its y in `out`.
    Moment moment(std::size_t node, std::vector<double>& out) const {
        out.resize(y.size());
        for (std::size_t k = 0; k < y.size(); ++k) out[k] = y[k][node];
        return {times[node], side(node), out};
    }
    /// The values of a function of the moment at the nodes.
    template <class Value>
    Nodes at_nodes(const Value& value, std::vector<double>& room) const {
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = value(moment(j, room));
        return values;
    }
    /// Returns a function of the moment as a function of the point x.
    template <class Value>
    auto function_of_x(const Value& value, std::vector<double>& room) const {
        return [&](double x) {
            state(x, room);
            return value(Moment{time(x), Side::at, room});
        };
    }
};

/// Causes that end a stretch. A kink: a normal load passes 0; a bend: the slip of bristles does; stays: a released
/// joint does not move.
enum class By { nobody, slip, release, wall, stop, slider, corner, relay, user, kink, bend, stays, condition };

struct Ending {
    double x = 1;  ///< point in the stretch, -1 to 1
    By by = By::nobody;
    std::size_t which = 0;  ///< index of the joint, or of the body of a relay
    /// which wall, corner or direction of release; for an elastic wall 0 means it is left; the relay's index; the
    /// sign of a normal load or slip from now on, 0 if it is as before
    int side = 0;
    std::vector<std::size_t> users = {};  ///< user events at this instant, in the order of their definition
    /// function and index of each condition that changes
    std::vector<std::pair<Piecewise*, std::size_t>> conditions = {};
    /// whether a crossed condition was clear of rounding at the start: a crossing there comes from the rounding of a
    /// long stretch
    bool blurred = false;
    /// Returns the latest point for user events and conditions. Those very close to a standstill, release or wall
    /// count as later: a value that is zero at a wall is not passed.
    double before() const {
        constexpr double beside_turn = 1e-12;
        const bool turns = by == By::slip || by == By::release || by == By::stays || by == By::wall;
        return x - (turns ? beside_turn : 0);
    }
};

/// Zeros closer than this count as simultaneous.
inline constexpr double one_instant = 64 * rounding;

/// The first point after the start whose time and angles differ from it by more than rounding.
inline double soon(const Segment& s) {
    constexpr double few = 64;
    return std::min(1.0, -1 + few * rounding * std::max(1.0, std::fabs(s.start.hi) / s.h));
}

}  // namespace dinal::motion::engine
