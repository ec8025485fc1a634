// The user's events: functions of the motion whose zeros are located.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/segment.hpp"
#include "motion/engine/signal.hpp"

namespace dinal::motion::engine {

/// Watches the zeros of user events and keeps the side of each. Actions are executed elsewhere.
class UserEvents {
public:
    UserEvents(const Mechanics& mechanics, const std::vector<model::WantedEvent>& wanted)
        : mechanics_(mechanics), wanted_(wanted), watches_(wanted.size()) {}

    const std::vector<Watch>& watches() const { return watches_; }
    void set_watches(const std::vector<Watch>& watches) { watches_ = watches; }

    struct Seen {
        bool good = true;  ///< whether all values are finite
        /// An event whose action reversed or stopped the value, and that crosses zero again without having clearly left
        /// it: the action would fire endlessly.
        std::optional<std::size_t> again = {};
    };
    /// Ends the stretch at the first event, if it precedes the present end.
    [[nodiscard]] Seen watch(const Segment& segment, Ending& ending);
    /// Accepts the watched stretch up to x; a repeated stretch is watched again from the same sides.
    void advance(double x);
    /// Returns whether all functions are formulas that certainly keep their sign while the motion is within these
    /// ranges.
    [[nodiscard]] bool stay_clear(const Ranges& ranges);

    /// Returns the events that pass zero at the present, within rounding.
    [[nodiscard]] std::vector<std::size_t> passing(const Now& now, const Segment& last, double h, Balances& balances,
                                                   const Frame& frame);
    std::vector<double> values(const Moment& at) const;
    /// Moves these events to their new sides before their actions.
    void flip_sides(const std::vector<std::size_t>& events);
    /// Sets the side of each value after actions, which may move values across zero without an event. If a reported
    /// event is still at zero (something else was changed, as in an impact), its side is the one it came from or, if it
    /// continues, the next one. `before` are the values before the actions, `h` is half the next stretch.
    void set_sides_after_actions(const std::vector<double>& before, const std::vector<std::size_t>& acted,
                                 const Now& now, const Segment& last, double h, Balances& balances, const Frame& frame);
    /// Registers an action that moved the bodies. Returns whether the intervals between its firings shrink towards
    /// zero.
    [[nodiscard]] bool fades(std::size_t event, double t) { return watches_[event].fading.register_firing(t); }

private:
    double value(std::size_t event, const Moment& at) const { return mechanics_.when(event, at); }
    double rounding_of(std::size_t event, const Now& now) const;
    [[nodiscard]] bool passes_on(std::size_t event, const Now& now, const Segment& last, double h, Balances& balances,
                                 const Frame& frame);

    const Mechanics& mechanics_;
    const std::vector<model::WantedEvent>& wanted_;
    std::vector<Watch> watches_;
    std::vector<Half> came_from_;  ///< sides before the last actions
    /// Zeros of the watched stretch in a direction that is no event: they only change the side.
    std::vector<std::pair<std::size_t, double>> unwanted_;
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
