// The gnuplot commands of one panel, in our own style.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "io/gnuplot_data.hpp"
#include "io/paper_layout.hpp"

namespace dinal {

/// For each curve the places of the points to draw, `gap` where the pen is lifted (io/thinning.hpp).
using Selection = std::vector<std::vector<std::size_t>>;

std::string panel_script(const Sheet& sheet, const Panel& panel, const Selection& kept, GnuplotData& data);

}  // namespace dinal
