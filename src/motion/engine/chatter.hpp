// The limits for what goes on without end and leads nowhere.
#pragma once

#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// The times between the acts of one event. Bounces of a user's own have ever shorter ones.
struct Fading {
    double last = -model::never, gap = model::never, first = 0;
    /// One more act, at time t. Returns whether the times between them fade to nothing.
    bool after(double t) {
        constexpr double next_to_nothing = 1e-5;
        const double now = t - last;
        if (!(now < gap) || gap == model::never) first = now;
        last = t, gap = now;
        return now < first && now <= next_to_nothing * first;
    }
};

/// Counts what follows each other at once: a run that gets nowhere ends.
class Chatter {
public:
    Chatter() = default;
    /// `unit`: of time.
    Chatter(double start, double unit) : unit_(unit), attempts_since_(start) {}

    /// An event at time t. Returns whether more than `most` followed each other at once.
    bool too_often(double t, int most = most_at_once) {
        constexpr double at_once = 1e-9;  // events that follow each other within it, so often, go on for ever
        at_once_in_a_row_ = t - last_event_ <= at_once * unit_ ? at_once_in_a_row_ + 1 : 0;
        last_event_ = t;
        return at_once_in_a_row_ > most;
    }
    /// A condition was crossed; `back`: soon after it was crossed the other way.
    void crossed(bool back) { to_and_fro_ = back ? to_and_fro_ + 1 : 0; }
    [[nodiscard]] bool to_and_fro_endlessly() const { return to_and_fro_ >= most_at_once; }
    /// One more attempt failed at time t. Returns whether `most` of them came no farther than a little.
    bool too_many_attempts(double t, int most) {
        if (++attempts_ < most) return false;
        if (t - attempts_since_ < 1e-7 * most * unit_) return true;
        attempts_ = 0, attempts_since_ = t;
        return false;
    }
    /// One more stretch is too short to be seen. Returns whether there were too many in a row.
    bool too_many_short() { return ++too_short_ > most_short; }
    void stretch_of(double length) {
        if (length > 1e-7 * unit_) too_short_ = 0;
    }
    /// A joint was let go and did not leave: it must be pulled clearly farther the next time. Returns whether that is
    /// more than rounding explains, after it was doubled often.
    static bool too_blunt(Slipping& how, double torques) {
        constexpr double most = 1e-9;  // of the torques
        how.blunt = std::max(2 * how.blunt, 64 * rounding * torques);
        return how.blunt > most * torques;
    }

private:
    static constexpr int most_at_once = 200, most_short = 400;
    double unit_ = 1, last_event_ = -model::never, attempts_since_ = 0;
    int at_once_in_a_row_ = 0, attempts_ = 0, too_short_ = 0;
    int to_and_fro_ = 0;  ///< crossings of one condition, each soon after the one before
};

}  // namespace dinal::motion::engine
