// What help() and the manual say about plot, run:plot and run:phase_plot: much, for they have many options.
#pragma once

#include "lua/bind.hpp"

namespace dinal::api {

/// Defined in bind_plot.cpp.
int plot_run(lua_State* L);
int phase_plot_run(lua_State* L);

inline constexpr lua::Doc plot_doc{
    "plot{ { x, y, label, style, dashes, colour, base }, ..., title, xlabel, ylabel, xlim, ylim, xticks, yticks, "
    "xlog, ylog, equal, axes, file, size, width, height, ascii, show }",
    "Draws curves, each a table with two vectors (or tables) of numbers; what is not finite is a gap. style is "
    "\"line\", \"points\" or \"fill\" (down to zero, or to the vector base), dashes is \"solid\", \"dashed\" or "
    "\"dotted\", colour is 1 to 7; without these, curves differ by themselves. xlim = { from, to } is what is "
    "seen, xticks the distance from tick to tick or a list of ticks, xlog = true a logarithmic axis, and the "
    "same for y; equal = true makes one unit as long on both axes, axes = false leaves only the curves. The "
    "picture is printed, width columns wide and height lines high (as the terminal is, or 79 and 22), in plain "
    "characters with ascii = true. With a file it is written instead, by the ending of its name: .svg, .png, "
    ".pdf (these three need gnuplot), .gp (gnuplot commands with the data, to be restyled) or .txt; size = { "
    "8.5, 6 } is then its size in cm. With show = false it is neither printed nor written, but returned; plot{ "
    "p, q } draws such pictures side by side.",
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
    "-->     -2              0             2"};

inline constexpr lua::Doc plot_run_doc{
    "run:plot{ x, y, title, xlabel, ylabel, xlim, ylim, xticks, yticks, xlog, ylog, equal, axes, file, size, "
    "width, height, ascii, show }",
    "Draws columns over a column: without options theta, and M/k when there is an excitation, over t, with bars "
    "where the mass sticks. x and y are names or numbers of columns, y also a list of them; M/k, friction/k, "
    "damping/k and velocity/omega0 are names, too. The other options are those of plot.",
    "run = nondimensional{ zeta = 0.05 }:simulate{ theta0 = 1, t_end = 4, dt = 0.01 }\n"
    "print(run:plot{ width = 60, height = 11, ascii = true, show = false })\n"
    "--> theta, rad\n"
    "--> 1 +..\n"
    "-->   | '.         ...\n"
    "-->   |  :.       .'  :.        .:'.          ...\n"
    "-->   |   :      .:    :       :'  ':.      .:' ':.      ..''\n"
    "--> 0 +- -'. - - : - - -:- - -:' - - :.- - :'- - -': - .:' -\n"
    "-->   |    :.   :       ':  .:'       ':..:'        ''''\n"
    "-->   |     :  :'        '::'\n"
    "-->   |      '''\n"
    "-->   ++------------+-------------+------------+------------+\n"
    "-->    0            1             2            3            4 t"};

inline constexpr lua::Doc phase_plot_run_doc{
    "run:phase_plot{ title, xlabel, ylabel, xlim, ylim, xticks, yticks, axes, file, size, width, height, ascii, show }",
    "Draws the phase plane, velocity/omega0 over theta, one to one: circles about the origin are lines of equal "
    "energy, and a mass that comes to rest within the dead zone stays there. Options as for plot.",
    "run = nondimensional{ friction_ratio = 0.1 }:simulate{ theta0 = 1, t_end = 3, dt = 0.01 }\n"
    "print(run:phase_plot{ width = 60, height = 14, ascii = true, show = false })\n"
    "--> theta'/omega0, rad   o start   @ end   = dead zone\n"
    "-->      |   .  *******     .\n"
    "-->  0.5 + . ****   . ***\n"
    "-->      |  **   ****    **   .\n"
    "-->      | **   **  ***   *\n"
    "-->  0.0 +.*. . * .=@** . * . .o.\n"
    "-->      | **   *   .     *   **\n"
    "-->      |  *    ***.  ***    *\n"
    "--> -0.5 + . **    *****    **\n"
    "-->      |   .****  .    ****\n"
    "-->      |       .*******.\n"
    "-->      +----------+----------+-\n"
    "-->                 0          1\n"
    "-->             theta, rad"};

}  // namespace dinal::api
