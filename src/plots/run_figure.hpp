// What is drawn of a run: its response in time, any of its columns, its phase plane.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "model/oscillator.hpp"
#include "motion/trajectory.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

struct RunData {
    std::shared_ptr<const void> owner;  ///< keeps the trajectory alive
    const motion::Trajectory* trajectory;
    const model::Oscillator* system;  ///< null in a run that was read from a file
};

/// Columns over a column: names of the run's columns, or "M/k", "friction/k", "damping/k" and "velocity/omega0", which
/// the record of 1989 has. No names: theta, and M/k when there is an excitation, over t.
text::Expected<Figure> column_figure(const RunData& run, std::string_view x, const std::vector<std::string>& ys);

/// theta'/omega0 over theta, 1:1: circles about the origin are lines of equal energy.
text::Expected<Figure> phase_figure(const RunData& run);

/// When the mass stuck, from the events.
std::vector<Interval> stuck_intervals(const motion::Trajectory& trajectory);

}  // namespace dinal::plots
