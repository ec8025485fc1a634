#include "plots/canvas.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "plots/figure.hpp"

namespace dinal::plots {
namespace {

// Unicode numbers the dots of a braille cell down the left column, down the right one, and then along the lowest row.
constexpr std::array<std::array<std::uint8_t, 4>, 2> braille_bits{{{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};

std::string braille(std::uint8_t dots) {  // U+2800 + dots
    return {'\xE2', static_cast<char>(0xA0U | (dots >> 6U)), static_cast<char>(0x80U | (dots & 0x3FU))};
}

constexpr double dot_reach = 0.49;  // tolerance in dots: a value at the limit must not be lost by rounding

}  // namespace

Canvas::Canvas(int columns, int rows, Charset charset)
    : columns_(columns),
      rows_(rows),
      charset_(charset),
      cell_width_(charset == Charset::braille ? 2 : 1),
      cell_height_(charset == Charset::braille ? 4 : 2),
      cells_(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}

std::size_t Canvas::place(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
}

const Canvas::Cell& Canvas::cell(int column, int row) const {
    return cells_[place(column, row)];
}

bool Canvas::has_ink() const {
    return std::ranges::any_of(cells_, [](const Cell& cell) { return cell.ink != 0; });
}

Canvas::Cell* Canvas::cell_of_dot(int x, int y) {
    const bool inside = x >= 0 && y >= 0 && x < width() && y < height();
    return inside ? &cells_[place(x / cell_width_, y / cell_height_)] : nullptr;
}

void Canvas::dot(int x, int y, std::uint8_t ink) {
    Cell* const cell = cell_of_dot(x, y);
    if (cell == nullptr) {
        return;
    }
    const std::uint8_t bit =
        braille_bits[static_cast<std::size_t>(x % cell_width_)][static_cast<std::size_t>(y % cell_height_)];
    if (ink == 0) {
        cell->behind = static_cast<std::uint8_t>(cell->behind | bit);
        return;
    }
    cell->dots = static_cast<std::uint8_t>(cell->dots | bit);
    if (cell->ink == 0) {
        cell->ink = ink;
    }
}

void Canvas::glyph(int x, int y, std::string_view character, std::uint8_t ink) {
    if (Cell* const cell = cell_of_dot(x, y)) {
        cell->glyph = character;
        cell->ink = ink;
    }
}

void Canvas::glyph_if_free(int x, int y, std::string_view character) {
    Cell* const cell = cell_of_dot(x, y);
    if (cell != nullptr && cell->dots == 0) {
        cell->glyph = character;
    }
}

std::string Canvas::text(const Cell& cell, char mark, char behind) const {
    if (!cell.glyph.empty()) {
        return std::string(cell.glyph);
    }
    if (charset_ == Charset::braille) {
        return braille(static_cast<std::uint8_t>(cell.dots | cell.behind));
    }
    if (cell.dots != 0 && mark != 0) {
        return {mark};
    }
    constexpr std::array<char, 4> halves{' ', '\'', '.', ':'};
    return {cell.dots != 0 ? halves[cell.dots & 3U] : cell.behind != 0 ? behind : ' '};
}

void Pen::to(double x, double y) {
    if (std::isnan(x) || std::isnan(y)) {
        down_ = false;
        return;
    }
    if (down_ && std::fabs(x - last_x_) < dot_reach && std::fabs(y - last_y_) < dot_reach && last_x_ >= 0) {
        x_ = x;
        y_ = y;
        return;  // this is the usual case for a million points
    }
    // A clamped point this far away has almost the same direction; without clamping, clipping would lose all digits.
    constexpr double far = 1e7;
    x = std::clamp(x, -far, far);
    y = std::clamp(y, -far, far);
    const double from_x = std::exchange(x_, x);
    const double from_y = std::exchange(y_, y);
    Line line{{down_ ? from_x : x, down_ ? from_y : y}, {x, y}};
    down_ = true;
    if (clip(line, {canvas_.width() - 1.0, canvas_.height() - 1.0}, dot_reach)) {
        this->line(nearest_dot(line.from.x), nearest_dot(line.from.y), nearest_dot(line.to.x), nearest_dot(line.to.y));
    }
}

void Pen::step(int x, int y) {
    if (x == last_x_ && y == last_y_) {
        return;
    }
    last_x_ = x;
    last_y_ = y;
    if (count_ < on_) {
        canvas_.dot(x, y, ink_);
    }
    count_ = (count_ + 1) % period_;
}

void Pen::line(int x, int y, int to_x, int to_y) {  // Bresenham's algorithm
    const int dx = std::abs(to_x - x);
    const int dy = -std::abs(to_y - y);
    const int step_x = x < to_x ? 1 : -1;
    const int step_y = y < to_y ? 1 : -1;
    int error = dx + dy;
    for (;;) {
        step(x, y);
        if (x == to_x && y == to_y) {
            return;
        }
        const int twice = 2 * error;
        if (twice >= dy) {
            error += dy;
            x += step_x;
        }
        if (twice <= dx) {
            error += dx;
            y += step_y;
        }
    }
}

}  // namespace dinal::plots
