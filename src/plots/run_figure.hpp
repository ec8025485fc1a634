// Figures of a run: response in time, any columns, phase plane; the order in which the bodies of a machine are drawn.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
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

/// The bodies 0 to count - 1 in an order in which linked ones are neighbours. It begins with a body that is never
/// second in a link, such as the motor of a drive, because Lua tables do not store the order of names.
std::vector<std::size_t> neighbours(std::size_t count, std::span<const std::pair<std::size_t, std::size_t>> links);

}  // namespace dinal::plots
