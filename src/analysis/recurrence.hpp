// Divides a run at its events into half cycles (motion in one direction) and sticks, and detects whether they repeat.
//
// Events include all zeros of the velocity and so all extremes. Impacts reverse the mass, too, and an opening contact
// ends a stick.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "model/drive.hpp"
#include "model/excitation.hpp"
#include "motion/run.hpp"

namespace dinal::analysis {

/// A half cycle or a stick.
struct Stretch {
    double from = 0, to = 0;
    model::State begin = {}, end = {};  ///< the velocity is 0 at events other than impacts
    bool stuck = false;
    std::optional<model::Event> begun_by = {}, ended_by = {};  ///< none at the ends of the run

    double lasts() const { return to - from; }
};

/// In order and without gaps from t_start to t_stop; a stretch may have zero length. Requires a computed run.
std::vector<Stretch> stretches(const motion::Run& run);

/// The total time during which the contact was open.
double time_open(const motion::Run& run);

/// The half cycles of theta, and its rests; on a belt from one extreme of theta to the next.
std::vector<Stretch> half_cycles(const motion::Run& run);

/// The last period of a motion that repeats, or soon will.
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

/// `period` is the period of M, or 0.
Swings swings(const std::vector<Stretch>& stretches, double period);

/// The lag of theta's fundamental behind that of M over the period of M before `until`, rad, from -pi/2 to 3 pi/2.
/// Empty if M has no fundamental or depends on the motion, or if there are too few rows. User functions are not called
/// again: their M is read from the rows.
std::optional<double> phase_lag(const motion::Run& run, const model::Excitation& excitation, double period,
                                double until);

}  // namespace dinal::analysis
