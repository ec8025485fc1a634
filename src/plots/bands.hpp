// What swings too densely to be seen behind another curve, as the band that it fills.
#pragma once

#include <span>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

/// The figures with bands in place of the curves behind others (Curve::behind) that turn back more often than the eye
/// can follow on `width`: in places that it parts, such as dots of a text or pixels of a sheet.
std::vector<Figure> with_bands(std::span<const Figure> figures, double width);

/// The figures with envelopes in place of all curves that turn nearly every second of these places: drawn as they are,
/// they would be noise.
std::vector<Figure> with_envelopes(std::span<const Figure> figures, double width);

/// The places of the curves, those behind others first.
std::vector<std::size_t> drawing_order(const Figure& figure);

}  // namespace dinal::plots
