// Selects the points of a curve that paper can show: the picture stays the same, the file small.
#pragma once

#include <cstddef>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The sheet in pixels; errors below half a pixel are invisible.
struct Paper {
    View view;
    Box pixels;
};

/// The indices of the points to draw, in order; an index without a point lifts the pen. Curves with columns keep the
/// first, last, lowest and highest point in each column of pixels, which draws the same. Other lines keep the corners
/// of a polyline within a fifth of a pixel; areas those of both edges; points one for each pixel.
std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper);

}  // namespace dinal::plots
