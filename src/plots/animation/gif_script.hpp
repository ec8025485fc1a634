// An animation as gnuplot commands that make a GIF of it.
#pragma once

#include <string>

#include "plots/animation/scene.hpp"

namespace dinal::plots::animation {

/// What gnuplot must get on its standard input. No word of a user is in it.
std::string gif_input(const Scene& scene);

}  // namespace dinal::plots::animation
