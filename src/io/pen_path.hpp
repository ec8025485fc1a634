// What a plotter's pen must do to leave the ink of a curve, and what it need not do.
#pragma once

#include <cstddef>
#include <vector>

#include "io/figure.hpp"

namespace dinal {

/// In pixels.
struct Point {
    double x, y;
};

/// Leaves out the points between which the curve is straight to within the tolerance: from a corner, a point can be
/// reached by straight lines of a certain range of directions, and the range narrows with each point on the way.
class Corners {
public:
    Corners(std::vector<std::size_t>& kept, double tolerance) : kept_(kept), tolerance_(tolerance) {}

    void add(std::size_t i, Point point);
    void finish();  ///< the piece ends here; the next point begins another one

private:
    void begin(std::size_t i, Point point);

    std::vector<std::size_t>& kept_;
    double tolerance_;
    bool open_ = false;
    bool has_cone_ = false;
    Point corner_{}, last_point_{};
    std::size_t last_ = 0;
    double middle_ = 0, low_ = 0, high_ = 0, reach_ = 0;
};

/// Where there is ink.
class Painted {
public:
    /// A line inks `coarseness` pixels to each side.
    Painted(Box pixels, double coarseness);

    /// Draws a line and tells whether that made a difference.
    bool line(Point from, Point to);

private:
    [[nodiscard]] bool is_blank(Point point) const;
    void paint(Point point);
    [[nodiscard]] std::size_t place(int x, int y) const;

    int brush_;  // pixels to each side
    int width_, height_;
    std::vector<bool> done_;
};

}  // namespace dinal
