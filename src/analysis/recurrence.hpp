// Does the motion repeat itself? Told from its events, which are all its velocity zeros and so its extremes, too.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/stretches.hpp"
#include "model/drive.hpp"

namespace dinal::analysis {

/// The last period of a motion that repeats itself, or is about to.
struct Recurrence {
    bool steady = false;  ///< else it still settles
    double period = 0;
    double drift = 0;  ///< how far theta gets in one period: 0 but for a stick-slip motion that is drawn along
    double amplitude = 0, centre = 0;  ///< half of the way between the extremes, and the middle between them
    double change = 0;                 ///< from the period before, in amplitudes
    double since = 0, until = 0;  ///< the motion has repeated itself (to a thousandth of its amplitude) from then on
    std::size_t stops = 0;        ///< in a period
    double stuck = 0;             ///< part of a period
};

/// The events of a run without those of the user that have no act, as these change nothing of the motion.
std::vector<model::Event> events_of_motion(const motion::Trajectory& run,
                                           const std::vector<model::WantedEvent>& wanted);

std::optional<Recurrence> recurrence(std::span<const model::Event> events);

/// How the amplitude of the last half cycles goes on, when the motion does not repeat itself.
enum class Trend { unknown, growing, shrinking, irregular };
struct Swings {
    Trend trend = Trend::unknown;        ///< unknown: too few
    std::array<double, 3> amplitudes{};  ///< the largest of three spans of time, the last one last
    double span = 0;                     ///< their length, time units
};

/// `period` of M, or 0.
Swings swings(const std::vector<Stretch>& stretches, double period);

}  // namespace dinal::analysis
