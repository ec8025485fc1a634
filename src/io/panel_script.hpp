// The gnuplot commands of one panel, in our own style.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/gnuplot_data.hpp"
#include "io/paper_layout.hpp"
#include "io/thinning.hpp"

namespace dinal {

/// What is drawn of a curve (io/thinning.hpp).
struct Trace {
    std::vector<std::size_t> places = {};  ///< of its points, `gap` where the pen is lifted
    Strokes ink = {};                      ///< or in their place; in pixels of the sheet from the corner of the box
};
using Selection = std::vector<Trace>;  ///< one for each curve

/// How broad a line is, in pixels.
inline constexpr double line_width = 1.3;

std::string panel_script(const Sheet& sheet, const Panel& panel, const Selection& kept, GnuplotData& data);

}  // namespace dinal
