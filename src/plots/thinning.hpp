// Which points of a curve a sheet of paper can show: the picture stays the same, the file stays small.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "plots/figure.hpp"

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

/// Inked from here to there along a row of the sheet.
struct Stroke {
    double from, to, y;
};

struct Strokes {
    std::vector<Stroke> all = {};
    double height = 0;  ///< of each row
};

/// A line or a cloud of points so dense that it is mostly ink: the cells of a grid that it touches, as at most so many
/// strokes, which are the coarser the fewer they may be. Layers lie one upon the other: the first is all of it, later
/// ones are where there are more points of a cloud.
std::vector<Strokes> inked(const Curve& curve, const Paper& paper, std::size_t most);

}  // namespace dinal::plots
