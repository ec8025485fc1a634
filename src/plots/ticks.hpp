// Where the ticks of an axis stand and what is written beside them.
#pragma once

#include <string>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

struct Ticks {
    std::vector<double> at;
    std::vector<std::string> text;  ///< "-0.5", "2e-9"
    /// What must be added to every text, "" almost always: "+1000000" where all numbers begin alike.
    std::string offset;
};

/// The ticks the axis asks for, else round numbers (1, 2 or 5 times a power of ten) in at most `most` + 1 places.
Ticks ticks_of(const Axis& axis, const Scale& scale, int most);

/// The radii of a figure's circles: through the ticks of the axis that has more of them.
std::vector<double> circles_of(const Figure& figure, const Ticks& x, const Ticks& y);

}  // namespace dinal::plots
