// Which points of a curve a sheet of paper can show: the picture stays the same, the file stays small.
#pragma once

#include <cstddef>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The sheet in pixels: half a pixel is an error that nobody sees.
struct Paper {
    View view;
    Box pixels;
};

/// The places in the curve of the points to draw, in order; a place without a point lifts the pen. With columns: the
/// first, last, lowest and highest point of each column of pixels (as good as all of them, extremes included). Of
/// another line: the corners of one that is nowhere further from the curve than a fifth of a pixel. Of an area: those
/// of both its edges. Of points: one in each pixel.
std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper);

}  // namespace dinal::plots
