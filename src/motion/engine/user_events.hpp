// The events of the user: functions of the motion that are watched for zeros.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "motion/engine/balance.hpp"
#include "motion/engine/crossing.hpp"
#include "motion/engine/ending.hpp"
#include "motion/engine/ranges.hpp"

namespace dinal::motion::engine {

/// Watches them, and knows on which side of zero each is. It does not act.
class UserEvents {
public:
    UserEvents(const Mechanics& mechanics, const std::vector<model::WantedEvent>& wanted)
        : mechanics_(mechanics), wanted_(wanted), watches_(wanted.size()) {}

    [[nodiscard]] const std::vector<Watch>& watches() const { return watches_; }
    void go_on_with(const std::vector<Watch>& watches) { watches_ = watches; }

    struct Seen {
        bool good = true;  ///< all values are finite
        /// An event that an act threw back, or stopped, and that is through zero without having been beyond rounding
        /// on the side that it came from: it would be thrown back again at once, and again.
        std::optional<std::size_t> again = {};
    };
    /// Ends the stretch at the first of them, if that is before its end.
    [[nodiscard]] Seen watch(const Segment& segment, Ending& ending);
    /// Returns whether each is read, and certainly stays on its side of zero where the motion is within these ranges.
    [[nodiscard]] bool stay_clear(const Ranges& ranges);

    /// Returns those that pass zero at the present, but for rounding.
    [[nodiscard]] std::vector<std::size_t> passing(const Now& now, const Segment& last, double h, Balances& balances,
                                                   const Frame& frame);
    [[nodiscard]] std::vector<double> values(const Moment& at) const;
    /// These are about to act.
    void pass(const std::vector<std::size_t>& events);
    /// An act may have put watched values on the other side of zero, which is no passing. A value of an event that was
    /// reported stands at zero still if something else has changed, as in a bounce: its half is the one that it came
    /// from, or, when it goes on, what it comes to next. `before`: the values before the act; `h`: of the next stretch.
    void stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& told, const Now& now,
                         const Segment& last, double h, Balances& balances, const Frame& frame);
    /// Notes an act that has moved the bodies. Returns whether the intervals between them fade to nothing.
    [[nodiscard]] bool fades(std::size_t event, double t) { return watches_[event].fading.after(t); }

private:
    [[nodiscard]] double value(std::size_t event, const Moment& at) const { return mechanics_.when(event, at); }
    [[nodiscard]] double rounding_of(std::size_t event, const Now& now) const;
    [[nodiscard]] bool passes_on(std::size_t event, const Now& now, const Segment& last, double h, Balances& balances,
                                 const Frame& frame);

    const Mechanics& mechanics_;
    const std::vector<model::WantedEvent>& wanted_;
    std::vector<Watch> watches_;
    std::vector<Half> came_from_;  ///< before the last ones acted
    std::vector<double> point_;
};

}  // namespace dinal::motion::engine
