// A picture in Lua: figures that were described but not yet drawn, and where drawing them leads.
#pragma once

#include <string>
#include <vector>

#include "lua/options.hpp"
#include "plots/figure.hpp"
#include "plots/gnuplot_script.hpp"
#include "plots/text_plot.hpp"

namespace dinal::api {

struct Picture {
    std::vector<plots::Figure> figures;
    plots::TextFormat format;
};

/// Changes the figure as its options say (plot_options.hpp).
void apply_options(lua_State* L, const lua::Options& options, plots::Figure& figure);
/// The same for figures one below the other, which share x.
void apply_options(lua_State* L, const lua::Options& options, std::vector<plots::Figure>& figures);

/// As its options say (plot_options.hpp), prints, writes the file, or with show = false leaves the picture on the
/// stack; returns the number of values left.
int deliver(lua_State* L, const lua::Options& options, std::vector<plots::Figure> figures);

/// plot{ ... }
int plot_vectors(lua_State* L);

/// Where pictures go that are shown: else to standard output, as text. Those that were written into a file are shown to
/// it, too, when they are.
enum class Shown { here, in_file };
using PictureViewer = void (*)(const Picture& picture, Shown where);
void show_pictures_by(PictureViewer viewer);

/// What gnuplot makes of these commands, within the limits of the script.
text::Expected<std::string> drawn_by_gnuplot(const std::string& commands);

/// The picture as an element <svg> for a page or a notebook, by gnuplot.
text::Expected<std::string> svg_of(const Picture& picture);

/// The text of the picture without the last line end.
std::string text_of_picture(const Picture& picture);

}  // namespace dinal::api
