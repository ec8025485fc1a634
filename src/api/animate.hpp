// run:animate(): a run in motion, in a file, a page or a notebook.
#pragma once

#include <optional>
#include <string>

#include "api/lua_run.hpp"
#include "api/picture.hpp"
#include "lua/bind.hpp"
#include "text/option.hpp"

namespace dinal::api {

struct AnimateOptions {
    std::optional<std::string> file = {};
    std::optional<double> speed = {}, from = {}, to = {};
};
inline constexpr text::Option animate_file_option[] = {
    text::option<&AnimateOptions::file>("file", "the .svg file of the animation; a browser plays it"),
};
inline constexpr text::Option animate_take_options[] = {
    {"speed", "time units per second", text::its_own, text::positive,
     "time units shown per second; by default the whole run in ten seconds", text::fills<&AnimateOptions::speed>},
    text::option<&AnimateOptions::from>("from", "start time; by default that of the run", {.unit = "time units"}),
    text::option<&AnimateOptions::to>("to", "end time; by default that of the run", {.unit = "time units"}),
};
inline constexpr auto all_animate_options =
    text::joined(animate_file_option, animate_take_options, model::units_option);
inline constexpr text::Call animate_call{"run:animate", "run:animate{ file = \"run.svg\" }", all_animate_options, true};
inline constexpr auto all_report_animate_options = text::joined(animate_take_options, model::units_option);
inline constexpr text::Call report_animate_call{"r:animate", "r:animate(run, { speed = 2 })",
                                                all_report_animate_options, true};

int animate_run(lua_State* L);

/// An animated SVG of a run, and its title.
struct Animation {
    std::string svg, title;
};
/// Makes the animation of the run at `index`, with the options of report_animate_call after it.
Animation animation_at(lua_State* L, int index);

/// Receives all animations, including those for files, if the output is not a terminal: the page of a script, or a
/// notebook.
using AnimationViewer = void (*)(const Animation& animation, Shown where);
void show_animations_by(AnimationViewer viewer);

inline constexpr lua::Doc animate_doc{
    "run:animate{ OPTIONS }",
    "Shows the mass in motion, with spring, walls, surface and sticking: in a file, in a notebook, or on the page "
    "of --report. Pictures are drawn at equal steps of time, also between rows. Several bodies stand side by side, or are discs on one axis if one of them "
    "rotates.",
    "run = system{ I = 1, k = 4, Rd = 0.3, Re = 0.5 }:simulate{ theta0 = 1, t_end = 6, dt = 1 }\n"
    "file = os.tmpname() .. \".svg\"\n"
    "run:animate{ file = file, speed = 2 }\n"
    "print(io.open(file):read(\"a\"):match('repeatCount=\"(%w+)\"'))  --> indefinite\n"
    "os.remove(file)",
    {&animate_call}};

}  // namespace dinal::api
