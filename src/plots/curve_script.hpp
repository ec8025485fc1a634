// The curves of a panel as what follows gnuplot's word `plot`.
#pragma once

#include <string>
#include <vector>

#include "plots/gnuplot_data.hpp"
#include "plots/paper_layout.hpp"
#include "plots/thinning.hpp"

namespace dinal::plots {

/// What is drawn of a curve (io/thinning.hpp).
struct Trace {
    std::vector<std::size_t> places = {};  ///< of its points, `gap` where the pen is lifted
    Strokes ink = {};                      ///< or in their place; in pixels of the sheet from the corner of the box
    std::vector<Strokes> layers = {};      ///< or these, of a crowd of points: the darker, the more there are
};

/// In the order in which they are to be drawn, for the panel's curve of that place.
std::vector<std::string> curve_elements(const PaperPanel& panel, std::size_t place, const Trace& trace,
                                        GnuplotData& data);

}  // namespace dinal::plots
