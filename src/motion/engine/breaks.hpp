// Undeclared breaks of a run: those that were found by search, and those that delays repeat.
#pragma once

#include <utility>
#include <vector>

#include "motion/break_search.hpp"
#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// A list of break times. The search itself is elsewhere.
class Breaks {
public:
    using Echo = std::pair<double, int>;  ///< time, and number of delays it has passed through

    explicit Breaks(const Mechanics& mechanics);

    double shortest_delay() const { return shortest_delay_; }
    double longest_delay() const { return longest_delay_; }
    /// The next break, or `never`.
    double next() const {
        double found = model::never;
        if (!found_.empty()) found = found_.front();
        return echoes_.empty() ? found : std::min(found, echoes_.front().first);
    }
    /// Adds a break. Returns false if it is already known.
    bool add(double t);
    bool has_too_many() const { return found_.size() >= most_found; }
    /// Removes breaks up to time t. If none is left and a load has jumped periodically, adds the next jump before
    /// `end`.
    void pass(double t, double end);

    /// Registers a jump at time t, which delays repeat later.
    void echo(double t, int generation);
    /// Turns echoes up to time t into echoes of the next generation. Returns whether there were any.
    bool pass_echoes(double t);
    const std::vector<Echo>& echoes() const { return echoes_; }
    void set_echoes(std::vector<Echo> echoes) { echoes_ = std::move(echoes); }

private:
    static constexpr std::size_t most_found = 50;

    const Mechanics& mechanics_;
    std::vector<double> found_;
    PassedBreaks passed_;
    std::vector<Echo> echoes_;
    double shortest_delay_ = model::never, longest_delay_ = 0;
};

}  // namespace dinal::motion::engine
