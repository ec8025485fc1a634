// Which points of a curve a sheet of paper can show: the picture stays the same, the file stays small.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "io/figure.hpp"

namespace dinal {

/// Stands in a list of points where the pen is lifted.
inline constexpr std::size_t gap = std::numeric_limits<std::size_t>::max();

/// The sheet in pixels: half a pixel is an error that nobody sees.
struct Paper {
    View view;
    Box pixels;
    /// Above 1 it saves room where curves are so dense that the paper is full of ink: pixels per column, and about half
    /// the distance from a line to one beside it.
    double coarseness = 1;
};

/// The places in the curve of the points to draw, in order, with `gap` between pieces. When x never falls: the first,
/// last, lowest and highest point of each column of pixels (as good as all of them, extremes included). Else the
/// corners of a line that is nowhere further from the curve than a fifth of a pixel or two; with a coarseness above 1
/// not those which would only paint over ink. The extremes in x and y are among them. Of points that no line joins, one
/// for each pixel, and none that the paper does not show.
std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper);

}  // namespace dinal
