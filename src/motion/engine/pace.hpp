// The length of the stretches of a run.
#pragma once

#include <algorithm>
#include <utility>

#include "model/excitation.hpp"
#include "motion/engine/nodes.hpp"

namespace dinal::motion::engine {

constexpr double short_part = 1e-3;  // a stretch below this fraction of the longest one is short

/// Controls the length of the next stretch by error estimates; events end stretches elsewhere.
struct Pace {
    double period = model::never;  ///< shortest period of the system without friction
    double unit = 1;               ///< time scale: the period, or the duration of a shorter run
    double longest = 1;            ///< longest stretch of the system without contacts
    double h = 1;                  ///< half the length of the next stretch
    double born = 0;               ///< start time of the first of several continued runs
    double bad_time = model::never;

    /// Returns whether no break has been searched for at t with a similar length, and registers the search.
    bool may_search(double t, double half) {
        if (searched_from_ == t && half > 0.1 * searched_half_) return false;
        searched_from_ = t, searched_half_ = half;
        return true;
    }
    /// Shortens the next stretch after an unresolved one; `half` is half its length, `unresolved` its relative error.
    void shorten(double half, double unresolved, double longest_now);
    /// Lengthens the next stretch by `factor` after a resolved one, up to `longest_now`.
    void lengthen(double half, double factor, double longest_now);
    /// Repeats the present stretch with half length `part`, and remembers `half` for later.
    void make_again(double part, double half) { h = part, whole_ = std::max(whole_, half); }
    /// Returns to the remembered length.
    void go_on() { h = std::max(h, std::exchange(whole_, 0)); }

private:
    double searched_from_ = model::never, searched_half_ = 0;
    double whole_ = 0;         ///< half length of the stretch that is being repeated in parts; 0: none
    double short_enough_ = 0;  ///< half length that replaced one with a slightly too large error
    int limited_for_ = 0;      ///< number of stretches that short_enough_ still limits
};

}  // namespace dinal::motion::engine
