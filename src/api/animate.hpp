// run:animate(): a run in motion, in the terminal or in a file.
#pragma once

#include <optional>
#include <string>

#include "api/units_option.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct AnimateOptions {
    std::optional<std::string> file = {};
    std::optional<double> speed = {}, from = {}, to = {};
    std::optional<bool> ascii = {};
};
inline constexpr text::Option animate_options[] = {
    {.name = "file",
     .meaning = "where it is written instead of shown: .svg, which a browser plays, or .gif (by gnuplot)",
     .filled = text::fills<&AnimateOptions::file>},
    {"speed", "time units per second", text::its_own, text::positive, "how fast, else all of it in ten seconds",
     text::fills<&AnimateOptions::speed>},
    {"from", "time units", text::its_own, text::any_finite, "where it begins, else with the run",
     text::fills<&AnimateOptions::from>},
    {"to", "time units", text::its_own, text::any_finite, "where it ends, else with the run",
     text::fills<&AnimateOptions::to>},
    {.name = "ascii", .meaning = "plain characters", .filled = text::fills<&AnimateOptions::ascii>},
};
inline constexpr auto all_animate_options = text::joined(animate_options, model::units_option);
inline constexpr text::Call animate_call{"run:animate", "run:animate{ speed = 2 }", all_animate_options, true};

int animate_run(lua_State* L);

inline constexpr lua::Doc animate_doc{
    "run:animate{ OPTIONS }",
    "Shows the mass in motion, with its spring, its walls, the surface (a belt moves) and where it sticks: in the terminal, "
    "until Ctrl-C, or in a file. It is drawn at equal steps of time, between the rows, too.",
    "run = system{ I = 1, k = 4, Rd = 0.3, Re = 0.5 }:simulate{ theta0 = 1, t_end = 6, dt = 1 }\n"
    "file = os.tmpname() .. \".svg\"\n"
    "run:animate{ file = file, speed = 2 }\n"
    "print(io.open(file):read(\"a\"):match('repeatCount=\"(%w+)\"'))  --> indefinite\n"
    "os.remove(file)",
    {&animate_call}};

}  // namespace dinal::api
