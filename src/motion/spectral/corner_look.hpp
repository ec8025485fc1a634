// What friction and springs do where no node is. A law may turn a corner that the motion passes for a short while
// only: at its extremes, or right before it stops.
#pragma once

#include <optional>

#include "model/slide.hpp"
#include "motion/spectral/chebyshev.hpp"

namespace dinal::motion::spectral {

/// A piece that moves, at its nodes.
struct CornerLook {
    const model::Lowered& system;
    const model::Slide& slide;
    model::Motion way;
    chebyshev::Samples theta, slip;  ///< slip: the velocity against the surface
    chebyshev::Samples remainder;    ///< what system.remainder() is, as the motion on the piece has felt it
};

/// The first place found at which the remainder is more than `allowed` away from the polynomial through its values at
/// the nodes, or not finite.
std::optional<double> missed_corner(const CornerLook& piece, double allowed);

/// How much shorter the next attempt is to be: it ends a little before that place.
double shorter_by_corner(double x);

}  // namespace dinal::motion::spectral
