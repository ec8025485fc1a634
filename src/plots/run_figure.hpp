// What is drawn of a run: its response in time, any of its columns, its phase plane.
#pragma once

#include <memory>
#include <optional>
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
    std::optional<model::Oscillator> system;  ///< none in a run that was read from a file, or is of several bodies
    model::Units units = {};
    std::optional<double> load = {};  ///< the torque on the mass besides that of its system; none if it varies
};

enum class Axes { one_a_unit, one };

/// Names of the run's columns, or "M/k", "friction/k", "damping/k" and "velocity/omega0", which the record of 1989 has.
struct ColumnsToDraw {
    std::string x = {};                    ///< t without it
    std::vector<std::string> ys = {};      ///< none: theta, and M/k when there is an excitation
    std::vector<std::string> labels = {};  ///< for the first of these, in place of their names
    Axes axes = Axes::one_a_unit;
};

/// Columns over a column. What is measured in different units stands in figures one below the other.
text::Expected<std::vector<Figure>> column_figures(const RunData& run, const ColumnsToDraw& asked = {});

/// theta'/omega0 over theta, 1:1: where k theta alone pulls back, circles about the origin are lines of equal energy.
/// Without k it is theta'.
text::Expected<Figure> phase_figure(const RunData& run);

/// How the column of this name is written in a picture: "θ'" for velocity.
std::string symbol_for(std::string_view column);

/// When the mass stuck, from the events.
std::vector<Interval> stuck_intervals(const motion::Trajectory& trajectory);

}  // namespace dinal::plots
