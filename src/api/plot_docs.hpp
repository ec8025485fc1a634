// What help() and the manual say about plot, run:plot and run:phase_plot besides their options.
#pragma once

#include "api/plot_options.hpp"
#include "lua/bind.hpp"

namespace dinal::api {

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
    "Draws columns over a column, with bars where the mass sticks.",
    "run = system{ I = 1, k = 39.5, C = 0.6 }:simulate{ theta0 = 1, t_end = 4, dt = 0.01 }\n"
    "print(run:plot{ width = 60, height = 11, ascii = true, show = false })\n"
    "--> theta, rad\n"
    "--> 1 +..\n"
    "-->   | '.         ...\n"
    "-->   |  :.       .'  :.        .'':          ...\n"
    "-->   |   :      .:    :       :'  ':.      .:' ':.      .:''\n"
    "--> 0 +- -'. - - : - - -:- - -:- - - :.- - :'- - -'. - .:' -\n"
    "-->   |    :.   :       ':  .:'       ':..:'        '::'\n"
    "-->   |     :  :'        ':.'\n"
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
    "-->  0.5 + . ****   . ***\n"
    "-->      |  **   ****    **   .\n"
    "-->      | **   **  ***   *\n"
    "-->  0.0 +.*. . * .=@** . * . .o.\n"
    "-->      | **   *   .     *   **\n"
    "-->      |  *    ***.  ***    *\n"
    "--> -0.5 + . **    *****    **\n"
    "-->      |   . ***  .    ****\n"
    "-->      |       .*******.\n"
    "-->      +----------+----------+-\n"
    "-->                 0          1\n"
    "-->             theta, rad",
    {&phase_plot_call}};

}  // namespace dinal::api
