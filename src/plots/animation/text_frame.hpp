// One frame of an animation in characters.
#pragma once

#include <string>
#include <vector>

#include "plots/animation/scene.hpp"
#include "plots/canvas.hpp"

namespace dinal::plots::animation {

struct FrameFormat {
    int columns = 80;  ///< no line is longer
    Charset charset = Charset::braille;
    bool colours = false;
};

/// Always as many lines: time and place, two of the mass on its spring between its walls, the surface, a scale.
std::vector<std::string> text_frame(const Scene& scene, const Frame& frame, const FrameFormat& format);

}  // namespace dinal::plots::animation
