// The options of plot, run:plot and run:phase_plot: the parts of a figure, where it goes, and each of its curves.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "model/units.hpp"
#include "plots/figure.hpp"
#include "text/option.hpp"

namespace dinal::api {

/// What is absent stays as the figure has it.
struct FigureOptions {
    std::optional<std::string> title = {}, xlabel = {}, ylabel = {};
    std::optional<std::vector<double>> xlim = {}, ylim = {};
    std::optional<bool> xlog = {}, ylog = {}, equal = {}, axes = {};
};

inline constexpr text::Range tick_distance{"be positive: it is the distance between ticks",
                                           [](double x) { return x > 0; }};
inline constexpr const char* ticks_meaning = "distance between ticks, or a list of ticks";

inline constexpr text::Option figure_options[] = {
    {.name = "title", .meaning = "title", .filled = text::fills<&FigureOptions::title>},
    {.name = "xlabel", .meaning = "label of the x axis", .filled = text::fills<&FigureOptions::xlabel>},
    {.name = "ylabel", .meaning = "label of the y axis", .filled = text::fills<&FigureOptions::ylabel>},
    {.name = "xlim", .meaning = "visible range, { from, to }", .filled = text::fills<&FigureOptions::xlim>},
    {.name = "ylim", .meaning = "the same for y", .filled = text::fills<&FigureOptions::ylim>},
    {.name = "xticks", .range = tick_distance, .meaning = ticks_meaning},
    {.name = "yticks", .range = tick_distance, .meaning = ticks_meaning},
    {.name = "xlog", .meaning = "a logarithmic axis", .filled = text::fills<&FigureOptions::xlog>},
    {.name = "ylog", .meaning = "a logarithmic axis", .filled = text::fills<&FigureOptions::ylog>},
    {.name = "equal", .meaning = "one unit is as long on both axes", .filled = text::fills<&FigureOptions::equal>},
    {.name = "axes", .meaning = "false leaves only the curves", .filled = text::fills<&FigureOptions::axes>},
};

/// Where a picture goes, and how large it is.
struct TargetOptions {
    std::optional<std::string> file = {};
    std::optional<std::vector<double>> size = {};
    std::optional<int> width = {}, height = {};
    std::optional<bool> ascii = {};
    bool show = true;
};

inline constexpr text::Option target_options[] = {
    {.name = "file",
     .meaning = "file to write instead of printing; the ending of the name chooses the format: .svg, .png, "
                ".pdf (these need gnuplot), .gp (gnuplot commands with the data, to be restyled) or .txt",
     .filled = text::fills<&TargetOptions::file>},
    {.name = "size",
     .unit = "cm",
     .meaning = "{ width, height } in a file",
     .filled = text::fills<&TargetOptions::size>},
    {.name = "width",
     .range = {"be a whole number from 20 to 1000: columns of text",
               [](double x) { return text::is_whole(x, 20, 1000); }},
     .meaning = "columns of the text; by default those of the terminal, or 79",
     .filled = text::fills<&TargetOptions::width>},
    {.name = "height",
     .range = {"be a whole number from 5 to 500: lines of text", [](double x) { return text::is_whole(x, 5, 500); }},
     .meaning = "lines of the text; by default those of the terminal, or 22",
     .filled = text::fills<&TargetOptions::height>},
    {.name = "ascii", .meaning = "plain characters", .filled = text::fills<&TargetOptions::ascii>},
    {.name = "show",
     .meaning = "false returns the picture, for print or for plot{ p, q }",
     .filled = text::fills<&TargetOptions::show>},
};

inline constexpr text::Option column_options[] = {
    {.name = "x", .otherwise = "\"t\"", .meaning = "name or number of a column"},
    {.name = "y",
     .meaning = "name or number of a column, or a list of them; by default theta, and M/k if there is an "
                "excitation; M/k, friction/k, damping/k and velocity/omega0 are names, too; columns with "
                "other units get an axis of their own, below"},
    {.name = "labels",
     .meaning = "names of the columns in the picture",
     .wanted = "a list of words such as { \"angle\", \"torque\" }"},
};

inline constexpr auto plot_options = text::joined(figure_options, target_options);
inline constexpr text::Call plot_call{"plot", "plot{ { t, theta, label = \"theta\" }, xlabel = \"t\" }", plot_options};
inline constexpr text::Call pictures_call{"plot", "plot{ picture, picture, file = \"both.svg\" }", target_options};
inline constexpr text::Call curve_call{"plot: curve", "{ x, y, label = \"theta\", style = \"points\" }",
                                       plots::curve_options};
inline constexpr auto plot_run_options =
    text::joined(column_options, model::units_option, figure_options, target_options);
inline constexpr auto phase_plot_options = text::joined(model::units_option, figure_options, target_options);
inline constexpr text::Call plot_run_call{"run:plot", "run:plot{ y = { \"theta\", \"friction\" }, file = \"run.svg\" }",
                                          plot_run_options, true};
inline constexpr text::Call phase_plot_call{"run:phase_plot", "run:phase_plot{ file = \"phase.svg\" }",
                                            phase_plot_options, true};

}  // namespace dinal::api
