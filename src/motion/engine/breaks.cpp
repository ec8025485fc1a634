#include "motion/engine/breaks.hpp"

#include <algorithm>

namespace dinal::motion::engine {

Breaks::Breaks(const Mechanics& mechanics) : mechanics_(mechanics) {
    mechanics.for_each_signal([&](const Signal& s) {
        for (const double by : s.delays()) {
            shortest_delay_ = std::min(shortest_delay_, by), longest_delay_ = std::max(longest_delay_, by);
        }
    });
}

bool Breaks::add(double t) {
    const auto place = std::lower_bound(found_.begin(), found_.end(), t);
    if (place != found_.end() && *place == t) return false;
    found_.insert(place, t);
    return true;
}

void Breaks::pass(double t, double end) {
    if (found_.empty()) return;
    while (!found_.empty() && found_.front() <= t) {
        passed_.pass(found_.front());
        found_.erase(found_.begin());
    }
    for (const Signal& load : mechanics_.loads()) {
        if (!load.changes_in_time() || !found_.empty()) continue;
        const auto value = [&](double at) { return load.of_time({at, Side::at, {}}); };
        if (const auto next = passed_.next(end, value)) found_.push_back(*next);
    }
}

void Breaks::echo(double t, int generation) {
    constexpr int most_echoes = 8;
    if (generation > most_echoes) return;
    mechanics_.for_each_signal([&](const Signal& s) {
        for (const double by : s.delays()) {
            const Echo back{t + by, generation};
            echoes_.insert(std::lower_bound(echoes_.begin(), echoes_.end(), back), back);
        }
    });
}

bool Breaks::pass_echoes(double t) {
    int generation = 0;
    while (!echoes_.empty() && echoes_.front().first <= t) {
        generation = std::max(generation, echoes_.front().second);
        echoes_.erase(echoes_.begin());
    }
    if (generation > 0) echo(t, generation + 1);
    return generation > 0;
}

}  // namespace dinal::motion::engine
