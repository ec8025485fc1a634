// Which points of a curve a sheet of paper can show: the picture stays the same, the file stays small.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "plots/pen_path.hpp"

namespace dinal::plots {

/// Stands in a list of points where the pen is lifted.
inline constexpr std::size_t gap = std::numeric_limits<std::size_t>::max();

/// The sheet in pixels: half a pixel is an error that nobody sees.
struct Paper {
    View view;
    Box pixels;
    double coarseness = 1;  ///< above 1 it saves room: pixels to a column
};

/// A line or an area whose x never falls.
bool has_columns(const Curve& curve);

/// The places in the curve of the points to draw, in order, with `gap` between pieces. With columns: the first,
/// last, lowest and highest point of each column of pixels (as good as all of them, extremes included). Of another
/// line: the corners of one that is nowhere further from the curve than a fifth of a pixel. Of points: one in each
/// pixel.
std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper);

/// The same as strokes on the paper, at most so many, for what has no such columns and is so dense that it is mostly
/// ink. The fewer strokes, the coarser they are.
Strokes inked(const Curve& curve, const Paper& paper, double pen, std::size_t most);

/// Of a crowd of points: how many of them there are, as up to four layers of strokes, each within the one before it;
/// the first is where there are any. At most so many strokes in all, in cells as fine as these let them be.
std::vector<Strokes> crowded(const Curve& curve, const Paper& paper, std::size_t most);

}  // namespace dinal::plots
