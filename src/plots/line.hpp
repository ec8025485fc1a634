// Points and straight lines on a sheet, in dots or pixels.
#pragma once

#include "plots/figure.hpp"

namespace dinal::plots {

struct Point {
    double x, y;
};

struct Line {
    Point from, to;
};

/// Cuts the line to the sheet, which reaches from -slack to its size and slack (Liang and Barsky); false when nothing
/// is left.
bool clip(Line& line, Box sheet, double slack);

}  // namespace dinal::plots
