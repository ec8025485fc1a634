// A figure's curves on a canvas of dots, without the frame around them.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "plots/canvas.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

/// Where values fall on the canvas, in dots.
struct Projection {
    View view;
    Box box;  // the dots from edge to edge
    [[nodiscard]] double x(double value) const {
        return view.x.has(value) ? view.x(value) * (box.width - 1) : std::nan("");
    }
    [[nodiscard]] double y(double value) const {
        return view.y.has(value) ? (1 - view.y(value)) * (box.height - 1) : std::nan("");
    }
};

struct Signs {
    std::array<std::string_view, 4> marks;  ///< by MarkKind
    std::string_view point, dead_zone;
};
Signs signs(Charset charset);

/// The letter of curve 1, 2, ...
char letter(std::size_t ink);
/// Letters tell curves apart as soon as there are two.
bool uses_letters(const Figure& figure);
/// A few curves have them at their ends, right of the canvas; many have them on the way, one after the other.
bool letters_at_ends(const Figure& figure);
/// The ink of curve 0, 1, ...
std::uint8_t ink_of(std::size_t curve);

/// Zero lines, circles, curves, marks.
void draw(Canvas& canvas, const Figure& figure, const Projection& projection, const std::vector<double>& circles,
          Charset charset);

}  // namespace dinal::plots
