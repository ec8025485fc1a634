// An animation as SVG that a browser plays by itself: SMIL, no script.
#pragma once

#include <string>

#include "plots/animation/scene.hpp"

namespace dinal::plots::animation {

/// The mass, its spring, walls and surface, and below them theta over t with a dot that goes along. Repeats for ever.
std::string animated_svg(const Scene& scene);

/// Blocks on a floor, or on belts, with what links them; or discs on one axis. Below, the angles over t.
std::string animated_svg(const RigScene& rig);

/// "A run in motion, t = 0 to 10"
std::string title_of(const Scene& scene);

}  // namespace dinal::plots::animation
