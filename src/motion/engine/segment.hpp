// A stretch of the motion of a system, as a stepper leaves it.
#pragma once

#include <array>
#include <vector>

#include "motion/clock.hpp"
#include "motion/engine/nodes.hpp"
#include "motion/engine/signal.hpp"

namespace dinal::motion::engine {

/// The result of a stepper, which all else reads: angles, velocities and states over a stretch without a jump.
struct Segment : NodeTimes {
    Clock start;
    double end = 0;                ///< exactly
    bool proven = true;            ///< functions that are read do nothing in it that their series do not
    bool may_grow = true;          ///< the next stretch may be longer than all before
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
    std::vector<Series> holding_series{};      ///< the same, of those whose torque is compared with a limit
    /// The most that holds each joint that sticks and whose limits change, backward and forward.
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
    /// The values of a function of the moment at the nodes.
    template <class Value>
    Nodes at_nodes(const Value& value, std::vector<double>& room) const {
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = value(moment(j, room));
        return values;
    }
    /// The same at any place.
    template <class Value>
    auto anywhere(const Value& value, std::vector<double>& room) const {
        return [&](double x) {
            state(x, room);
            return value(Moment{time(x), Side::at, room});
        };
    }
};

}  // namespace dinal::motion::engine
