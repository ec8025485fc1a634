// Figures as text, braille or ASCII, for a terminal, a pipe or a text file.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "plots/figure.hpp"

namespace dinal::plots {

enum class Charset { braille, ascii };

struct TextFormat {
    int columns = 79;
    int rows = 22;  ///< rows of the whole picture
    Charset charset = Charset::braille;
    bool colours = false;  ///< whether to use escape sequences; for a terminal only
};

/// The lines of the picture. Several figures stand side by side if there are enough columns, otherwise one below the
/// other.
std::string text_plot(std::span<const Figure> given, const TextFormat& format);

// A canvas of dots that becomes lines of text: two by four dots a character in braille, one by two in ASCII.

class Canvas {
public:
    Canvas(int columns, int rows, Charset charset);

    // In dots from the upper left corner. Dots are square.
    int width() const { return columns_ * cell_width_; }
    int height() const { return rows_ * cell_height_; }
    int columns() const { return columns_; }
    int rows() const { return rows_; }

    /// Sets a dot; ignored outside. `ink` is 1, 2, ... for a curve, 0 for the background.
    void dot(int x, int y, std::uint8_t ink);
    /// Puts a character in place of dots in the cell of that dot.
    void glyph(int x, int y, std::string_view character, std::uint8_t ink);

    void glyph_if_free(int x, int y, std::string_view character);  ///< only if no curve has dots there

    struct Cell {
        std::uint8_t dots = 0;    // one bit for each dot
        std::uint8_t behind = 0;  // dots of ink 0
        std::uint8_t ink = 0;     // the first curve that drew here
        std::string_view glyph;   // must outlive the canvas
    };
    const Cell& cell(int column, int row) const;
    bool has_ink() const;  ///< whether a curve has dots here
    /// The text of the cell. In ASCII, `mark` replaces the dots of a curve (0 keeps their shape), `behind` those of the
    /// background.
    std::string text(const Cell& cell, char mark, char behind) const;

private:
    std::size_t place(int column, int row) const;
    Cell* cell_of_dot(int x, int y);  // null outside

    int columns_, rows_;
    Charset charset_;
    int cell_width_, cell_height_;
    std::vector<Cell> cells_;
};

/// The dot nearest to a position; some dot outside of the canvas for nan and far positions.
inline int nearest_dot(double place) {
    if (std::isnan(place)) return -1'000'000;
    return static_cast<int>(std::floor(std::clamp(place, -1e6, 1e6) + 0.5));
}

/// Draws `on` of every `period` dots along a path: a solid, dashed or dotted line.
class Pen {
public:
    Pen(Canvas& canvas, std::uint8_t ink, int on = 1, int period = 1)
        : canvas_(canvas), ink_(ink), on_(on), period_(period) {}

    /// Draws a line to this point, in dots (not rounded); NaN lifts the pen. Lines are clipped to the canvas.
    void to(double x, double y);

private:
    void line(int x, int y, int to_x, int to_y);
    void step(int x, int y);

    Canvas& canvas_;
    std::uint8_t ink_;
    int on_, period_;
    int count_ = 0;
    bool down_ = false;
    double x_ = 0, y_ = 0;
    int last_x_ = -1, last_y_ = -1;  // the last dot drawn
};

}  // namespace dinal::plots
