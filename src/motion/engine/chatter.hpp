// Limits that end a run that would never advance.
#pragma once

#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// The intervals between firings of one event. A user's own impacts can make them shrink to zero.
struct Fading {
    double last = -model::never, gap = model::never, first = 0;
    /// Registers a firing at time t. Returns whether the intervals shrink towards zero.
    bool register_firing(double t) {
        constexpr double next_to_nothing = 1e-5;
        const double now = t - last;
        if (!(now < gap) || gap == model::never) first = now;
        last = t, gap = now;
        return now < first && now <= next_to_nothing * first;
    }
};

/// Counts events and failures that follow one another without progress in time.
class Chatter {
public:
    Chatter() = default;
    /// `unit` is the time scale of the motion.
    Chatter(double start, double unit) : unit_(unit), attempts_since_(start) {}

    /// Registers an event at time t. Returns whether more than `most` events followed one another at once.
    bool too_often(double t, int most = most_at_once) {
        constexpr double at_once = 1e-9;  // events closer than this count as following at once
        at_once_in_a_row_ = t - last_event_ <= at_once * unit_ ? at_once_in_a_row_ + 1 : 0;
        last_event_ = t;
        return at_once_in_a_row_ > most;
    }
    /// Registers the crossing of a condition; `back` says whether it reverses a crossing shortly before.
    void crossed(bool back) { to_and_fro_ = back ? to_and_fro_ + 1 : 0; }
    bool to_and_fro_endlessly() const { return to_and_fro_ >= most_at_once; }
    /// Registers a failed attempt at time t. Returns whether `most` of them made almost no progress.
    bool too_many_attempts(double t, int most) {
        if (++attempts_ < most) return false;
        if (t - attempts_since_ < 1e-7 * most * unit_) return true;
        attempts_ = 0, attempts_since_ = t;
        return false;
    }
    /// Registers a stretch too short to matter. Returns whether there were too many in a row.
    bool too_many_short() { return ++too_short_ > most_short; }
    void note_length(double length) {
        if (length > 1e-7 * unit_) too_short_ = 0;
    }
    /// Registers that a released joint did not move: its next release needs a clearly larger pull. Returns whether this
    /// margin has grown beyond what rounding explains.
    static bool raise_margin(Slipping& how, double torques) {
        constexpr double most = 1e-9;  // relative to the torques
        // A freewheel without friction may feel no torque at all.
        const double size = torques + smallest / rounding;
        how.margin = std::max(2 * how.margin, 64 * rounding * size);
        return how.margin > most * size;
    }

private:
    static constexpr int most_at_once = 200, most_short = 400;
    double unit_ = 1, last_event_ = -model::never, attempts_since_ = 0;
    int at_once_in_a_row_ = 0, attempts_ = 0, too_short_ = 0;
    int to_and_fro_ = 0;  ///< crossings of one condition, each shortly after the previous one
};

}  // namespace dinal::motion::engine
