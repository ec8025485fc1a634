// The cubic spline through points, by its slopes there: between two points it is the cubic of both values and slopes,
// and its first two derivatives go on through the points.
#pragma once

#include <span>
#include <vector>

namespace dinal::model::terms {

/// Its slopes at increasing times. At the second point and the last but one the third derivative goes on, too (not a
/// knot), as C. de Boor proposed; three points give a parabola, two a straight line.
std::vector<double> spline_slopes(std::span<const double> t, std::span<const double> values);

/// The same for a curve that repeats itself `period` after the first time, which is later than the last one.
std::vector<double> periodic_spline_slopes(std::span<const double> t, std::span<const double> values, double period);

}  // namespace dinal::model::terms
