// Breaks of a run that nobody announced: found ones, and those that delays bring back.
#pragma once

#include <utility>
#include <vector>

#include "motion/break_search.hpp"
#include "motion/engine/mechanics.hpp"

namespace dinal::motion::engine {

/// Holds times only. It does not search for breaks.
class Breaks {
public:
    using Echo = std::pair<double, int>;  ///< the time, and the number of delays that it came through

    explicit Breaks(const Mechanics& mechanics);

    [[nodiscard]] double shortest_delay() const { return shortest_delay_; }
    [[nodiscard]] double longest_delay() const { return longest_delay_; }
    /// Returns the first one ahead, or `never`.
    [[nodiscard]] double next() const {
        double found = model::never;
        if (!found_.empty()) found = found_.front();
        return echoes_.empty() ? found : std::min(found, echoes_.front().first);
    }
    /// Notes a break ahead. Returns false if it is noted already.
    bool add(double t);
    [[nodiscard]] bool many() const { return found_.size() >= most_found; }
    /// Forgets those up to time t. If no other is ahead and a load has jumped evenly, notes its next jump before `end`.
    void pass(double t, double end);

    /// Something jumps at time t: delays bring that back.
    void echo(double t, int generation);
    /// Echoes up to time t become echoes of the next generation. Returns whether there were any.
    bool pass_echoes(double t);
    [[nodiscard]] const std::vector<Echo>& echoes() const { return echoes_; }
    void go_on_with(std::vector<Echo> echoes) { echoes_ = std::move(echoes); }

private:
    static constexpr std::size_t most_found = 50;

    const Mechanics& mechanics_;
    std::vector<double> found_;
    PassedBreaks passed_;
    std::vector<Echo> echoes_;
    double shortest_delay_ = model::never, longest_delay_ = 0;
};

}  // namespace dinal::motion::engine
