// The cubic spline through points, given by its slopes there; its first two derivatives are continuous.
#pragma once

#include <span>
#include <vector>

namespace dinal::model::terms {

/// The slopes at increasing times. The third derivative is continuous at the second point and the last but one, too
/// (not-a-knot, C. de Boor); three points give a parabola, two a straight line.
std::vector<double> spline_slopes(std::span<const double> t, std::span<const double> values);

/// The slopes of a periodic spline. The period must exceed the span of the times.
std::vector<double> periodic_spline_slopes(std::span<const double> t, std::span<const double> values, double period);

}  // namespace dinal::model::terms
