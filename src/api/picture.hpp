// Pictures in Lua: figures described but not yet drawn, and their output.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lua/bind.hpp"
#include "lua/options.hpp"
#include "model/units.hpp"
#include "plots/figure.hpp"
#include "plots/text_plot.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct Picture {
    std::vector<plots::Figure> figures;
    plots::TextFormat format;
};

/// Applies the options to the figure.
void apply_options(lua_State* L, const lua::Options& options, plots::Figure& figure);
/// The same for figures one below the other with a common x axis.
void apply_options(lua_State* L, const lua::Options& options, std::vector<plots::Figure>& figures);

/// Prints the figures, writes the file, or with show = false pushes the picture; returns the number of pushed values.
int deliver(lua_State* L, const lua::Options& options, std::vector<plots::Figure> figures);

/// plot{ ... }
int plot_vectors(lua_State* L);

enum class Shown { here, in_file };
/// Receives shown pictures, and those written to a file. By default they go to standard output as text.
using PictureViewer = void (*)(const Picture& picture, Shown where);
void show_pictures_by(PictureViewer viewer);

/// The picture as an <svg> element for a page or notebook.
text::Expected<std::string> svg_of(const Picture& picture);

/// The text of the picture without its last newline.
std::string text_of_picture(const Picture& picture);

// The options of plot, run:plot and run:phase_plot: parts of the figure, its output, and each curve.

/// Absent options keep the figure's values.
struct FigureOptions {
    std::optional<std::string> title = {}, xlabel = {}, ylabel = {};
    std::optional<std::vector<double>> xlim = {}, ylim = {};
    std::optional<bool> xlog = {}, ylog = {}, equal = {}, axes = {};
    bool ends = false;
};

inline constexpr text::Range tick_distance{"be positive: it is the distance between ticks",
                                           [](double x) { return x > 0; }};
inline constexpr const char* ticks_meaning = "distance between ticks, or a list of ticks";

inline constexpr text::Option figure_options[] = {
    text::option<&FigureOptions::title>("title", "title"),
    text::option<&FigureOptions::xlabel>("xlabel", "label of the x axis"),
    text::option<&FigureOptions::ylabel>("ylabel", "label of the y axis"),
    text::option<&FigureOptions::xlim>("xlim", "visible range, { from, to }"),
    text::option<&FigureOptions::ylim>("ylim", "the same for y"),
    {.name = "xticks", .range = tick_distance, .meaning = ticks_meaning},
    {.name = "yticks", .range = tick_distance, .meaning = ticks_meaning},
    text::option<&FigureOptions::xlog>("xlog", "a logarithmic axis"),
    text::option<&FigureOptions::ylog>("ylog", "a logarithmic axis"),
    text::option<&FigureOptions::equal>("equal", "one unit is as long on both axes"),
    text::option<&FigureOptions::axes>("axes", "false leaves only the curves"),
    text::option<&FigureOptions::ends>("ends", "in a file, puts the names of lines at their ends, not in the legend"),
};

/// The destination and size of a picture.
struct TargetOptions {
    std::optional<std::string> file = {};
    std::optional<std::vector<double>> size = {};
    std::optional<int> width = {}, height = {};
    std::optional<bool> ascii = {};
    bool show = true;
};

inline constexpr text::Option target_options[] = {
    text::option<&TargetOptions::file>(
        "file",
        "file to write instead of printing; the ending of the name chooses the format: .svg, .png, "
        ".pdf or .txt"),
    text::option<&TargetOptions::size>("size", "{ width, height } in a file", {.unit = "cm"}),
    text::option<&TargetOptions::width>("width", "columns of the text; by default those of the terminal, or 79",
                                        {.range = {"be a whole number from 20 to 1000: columns of text",
                                                   [](double x) { return text::is_whole(x, 20, 1000); }}}),
    text::option<&TargetOptions::height>("height", "lines of the text; by default those of the terminal, or 22",
                                         {.range = {"be a whole number from 5 to 500: lines of text",
                                                    [](double x) { return text::is_whole(x, 5, 500); }}}),
    text::option<&TargetOptions::ascii>("ascii", "plain characters"),
    text::option<&TargetOptions::show>("show", "false returns the picture, for print or for plot{ p, q }"),
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

// The documentation of plot, run:plot and run:phase_plot beyond their options.

/// Defined in bind_plot.cpp.
int plot_run(lua_State* L);
int phase_plot_run(lua_State* L);

inline constexpr lua::Doc plot_doc{
    "plot(x, y), plot{ { x, y, OPTIONS }, ..., OPTIONS }",
    "Draws y over x, or several curves, each a table with two vectors (or tables) of numbers; numbers that are "
    "not finite are gaps. A run is drawn as theta over t: plot{ run, { other, label = \"more friction\" } }. "
    "plot{ p, q } draws pictures side by side.",
    "x = vector.linspace(-2, 2, 9)\n"
    "p = plot{ { x, x^2, style = \"points\" }, width = 40, height = 10, ascii = true, show = false }\n"
    "print(p)\n"
    "--> 4 +  x                            x\n"
    "-->   |\n"
    "-->   |\n"
    "-->   |     x                      x\n"
    "--> 2 +\n"
    "-->   |         x              x\n"
    "-->   |             x      x\n"
    "--> 0 +- - - - - - - - -x- - - - - - - -\n"
    "-->   +--+--------------+-------------+--\n"
    "-->     -2              0             2",
    {&curve_call, &plot_call}};

inline constexpr lua::Doc plot_run_doc{
    "run:plot{ OPTIONS }",
    "Draws columns over a column, with bars where the mass sticks. theta, velocity, damping and states are drawn from the "
    "motion between the rows, and M if t, theta and velocity determine it; other columns, and runs that kept only their "
    "rows (dense = false, files, rk4, dinal1989), from the rows. Of several bodies the angles are drawn, each in a picture "
    "of its own, and those of links with friction; columns with names such as load.theta are drawn from the rows.",
    "run = system{ I = 1, k = 39.5, C = 0.6 }:simulate{ theta0 = 1, t_end = 4, dt = 0.01 }\n"
    "print(run:plot{ width = 60, height = 11, ascii = true, show = false })\n"
    "--> theta, rad\n"
    "--> 1 +..\n"
    "-->   | ':         ...\n"
    "-->   |  :.       :'  :.        :'':          ...\n"
    "-->   |   :      .:    :       :'  ':.      .:' ':.      .:''\n"
    "--> 0 +- -': - - : - - ':- - -:' - - :.- - :'- - -': - .:' -\n"
    "-->   |    :.   :'      ':  .:'       ':..:'       ''::'\n"
    "-->   |     :. :'        ':.'\n"
    "-->   |      '''\n"
    "-->   ++------------+-------------+------------+------------+\n"
    "-->    0            1             2            3            4 t",
    {&plot_run_call}};

inline constexpr lua::Doc phase_plot_run_doc{
    "run:phase_plot{ OPTIONS }",
    "Draws the phase plane, velocity/omega0 over theta, with equal scales: without a second spring, circles "
    "about the origin are lines of equal energy. Without k the velocity itself is drawn.",
    "run = system{ I = 1, k = 39.5, Rd = 3.95 }:simulate{ theta0 = 1, t_end = 3, dt = 0.01 }\n"
    "print(run:phase_plot{ width = 60, height = 14, ascii = true, show = false })\n"
    "--> theta'/omega0, rad   o start   @ end   = dead zone\n"
    "-->      |   .  *******     .\n"
    "-->  0.5 + . ****   . ****\n"
    "-->      |  **   ****    **   .\n"
    "-->      | **   **  ***   *\n"
    "-->  0.0 +.*. . * .=@** . * . .o.\n"
    "-->      | **   *   .    **   **\n"
    "-->      |  **   ***.  ***   **\n"
    "--> -0.5 + . **    *****    **\n"
    "-->      |   .****  .   *****\n"
    "-->      |       .*******.\n"
    "-->      +----------+----------+-\n"
    "-->                 0          1\n"
    "-->             theta, rad",
    {&phase_plot_call}};

}  // namespace dinal::api
