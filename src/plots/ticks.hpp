// The ticks of an axis and their labels.
#pragma once

#include <string>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

struct Ticks {
    std::vector<double> at;
    std::vector<std::string> text;  ///< "-0.5", "2e-9"
    /// Added to every label, usually "": "+1000000" if all numbers begin alike.
    std::string offset;
};

/// The axis's own ticks, otherwise at most `most` + 1 round numbers (multiples of 1, 2 or 5 times a power of ten).
Ticks ticks_of(const Axis& axis, const Scale& scale, int most);

/// The radii of a figure's circles, through the ticks of the axis with more ticks.
std::vector<double> circles_of(const Figure& figure, const Ticks& x, const Ticks& y);

}  // namespace dinal::plots
