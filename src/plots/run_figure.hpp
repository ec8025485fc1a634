// Figures of a run: response in time, any columns, phase plane.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/oscillator.hpp"
#include "motion/run.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

struct RunData {
    std::shared_ptr<const void> owner;  ///< owner of the run
    const motion::Run* result;
    std::optional<model::Oscillator> system;  ///< none if read from a file, or for several bodies
    model::Units units = {};
    std::optional<double> load = {};  ///< constant torque on the mass in addition to its system's; none if it varies
};

enum class Axes { one_a_unit, one };

/// Names of columns, or "M/k", "friction/k", "damping/k" and "velocity/omega0" as in the record of 1989.
struct ColumnsToDraw {
    std::string x = {};                    ///< default t
    std::vector<std::string> ys = {};      ///< default theta, and M/k with an excitation
    std::vector<std::string> labels = {};  ///< labels for the first of these instead of their names
    Axes axes = Axes::one_a_unit;
};

/// Columns over a column; quantities with different units are in figures one below the other.
text::Expected<std::vector<Figure>> column_figures(const RunData& run, const ColumnsToDraw& asked = {});

/// theta'/omega0 over theta with equal units: circles about the origin have equal energy if k theta is the only spring
/// torque. Without k plots theta'.
text::Expected<Figure> phase_figure(const RunData& run);

/// The symbol of a column in pictures: "θ'" for velocity.
std::string symbol_for(std::string_view column);

/// The intervals of sticking, from the events.
std::vector<Interval> stuck_intervals(const motion::Run& run);

}  // namespace dinal::plots
