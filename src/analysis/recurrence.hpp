// Detects a periodic motion from its events, which include all zeros of the velocity and so all extremes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "analysis/stretches.hpp"
#include "model/drive.hpp"

namespace dinal::analysis {

/// The last period of a motion that repeats itself, or soon will.
struct Recurrence {
    bool steady = false;  ///< whether it repeats; otherwise it still settles
    double period = 0;
    double drift = 0;  ///< change of theta in a period: nonzero only for a stick-slip motion that advances
    double amplitude = 0, centre = 0;  ///< half the distance between the extremes, and their middle
    double change = 0;                 ///< change from the period before, in amplitudes
    double since = 0, until = 0;       ///< interval in which the motion repeats within a thousandth of its amplitude
    std::size_t stops = 0;             ///< stops in a period
    double stuck = 0;                  ///< part of a period
};

/// The events of a run except user events without an action, which do not affect the motion.
std::vector<model::Event> events_of_motion(const motion::Run& run, const std::vector<model::WantedEvent>& wanted);

std::optional<Recurrence> recurrence(std::span<const model::Event> events);

/// The trend of the last half cycles of a motion that does not repeat.
enum class Trend { unknown, growing, shrinking, irregular };
struct Swings {
    Trend trend = Trend::unknown;        ///< unknown: too few half cycles
    std::array<double, 3> amplitudes{};  ///< greatest amplitude in each of three successive spans
    double span = 0;                     ///< length of a span, time units
};

/// `period` of M, or 0.
Swings swings(const std::vector<Stretch>& stretches, double period);

}  // namespace dinal::analysis
