// How things look on paper, as gnuplot is told: colours, dashes, marks.
#pragma once

#include <string>
#include <string_view>

#include "plots/figure.hpp"

namespace dinal::plots {

/// How broad a line is, in pixels of 1/96 inch.
inline constexpr double line_width = 1.3;

inline constexpr std::string_view ink_colour = "#444444";        // of words, axes and marks
inline constexpr std::string_view dead_zone_colour = "#B0B0B0";  // and the motion is drawn over it

// The figure's curve of that place, from 0:
std::string colour_of(const Figure& figure, std::size_t curve);
/// The same, paler: 1 is full, 0 white.
std::string tint_of(const Figure& figure, std::size_t curve, double strength);
std::string line_style(const Figure& figure, std::size_t curve);
std::string point_style(const Figure& figure, std::size_t curve);
std::string fill_style(const Figure& figure, std::size_t curve);
/// Of a dot, which must be broader than a line to be seen.
std::string dot_style(const Figure& figure, std::size_t curve);

std::string mark_style(MarkKind kind);

}  // namespace dinal::plots
