// The length of the stretches of a run.
#pragma once

#include <algorithm>
#include <utility>

#include "model/excitation.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

constexpr double short_part = 1e-3;  // shorter than this part of the longest stretch is short

/// Sets the length of the next stretch. It knows nothing of what ends one.
struct Pace {
    double period = model::never;  ///< the shortest of the system without friction
    double unit = 1;               ///< the period, or all of a run that is shorter
    double longest = 1;            ///< stretch in a system without contacts
    double h = 1;                  ///< half of the next stretch
    double born = 0;               ///< the time at which the first of the runs began that go on
    double bad_time = model::never;

    /// Returns whether no break was searched for here yet in a stretch like this one, and notes the search.
    bool may_search(double t, double half) {
        if (searched_from_ == t && half > 0.1 * searched_half_) return false;
        searched_from_ = t, searched_half_ = half;
        return true;
    }
    /// After a stretch of this half length that was not resolved, by this factor.
    void shorten(double half, double unresolved, double longest_now);
    /// After one that was, and may be longer by a factor; no longer than `longest_now`.
    void lengthen(double half, double factor, double longest_now);
    /// The next stretch is a short part of this one, which is made again.
    void make_again(double part, double half) { h = part, whole_ = std::max(whole_, half); }
    /// What was to be seen in the short one is behind.
    void go_on() { h = std::max(h, std::exchange(whole_, 0)); }

private:
    double searched_from_ = model::never, searched_half_ = 0;
    double whole_ = 0;         ///< half the length of a stretch that is made again; 0: none
    double short_enough_ = 0;  ///< half the length that replaced one with a slightly too large error
    int limited_for_ = 0;      ///< the number of the next stretches that are not longer than that
};

}  // namespace dinal::motion::engine
