// Figures as text: braille or ASCII, for a terminal, a pipe or a text file.
#pragma once

#include <span>
#include <string>

#include "plots/canvas.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

struct TextFormat {
    int columns = 79;
    int rows = 22;  ///< of a picture, all that is around it included
    Charset charset = Charset::braille;
    bool colours = false;  ///< escape sequences, for a terminal only
};

/// The lines of the picture. Several figures stand side by side where the columns suffice, else one under the other.
std::string text_plot(std::span<const Figure> given, const TextFormat& format);

}  // namespace dinal::plots
