// Figures as text, braille or ASCII, for a terminal, a pipe or a text file.
#pragma once

#include <span>
#include <string>

#include "plots/canvas.hpp"
#include "plots/figure.hpp"

namespace dinal::plots {

struct TextFormat {
    int columns = 79;
    int rows = 22;  ///< rows of the whole picture
    Charset charset = Charset::braille;
    bool colours = false;  ///< whether to use escape sequences; for a terminal only
};

/// The lines of the picture. Several figures stand side by side if there are enough columns, otherwise one below the
/// other.
std::string text_plot(std::span<const Figure> given, const TextFormat& format);

}  // namespace dinal::plots
