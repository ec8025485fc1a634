// What a plotter's pen must do to leave the ink of a curve, and what it need not do.
#pragma once

#include <cstddef>
#include <vector>

#include "plots/line.hpp"

namespace dinal::plots {

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

/// Inked from here to there along a row of the sheet.
struct Stroke {
    double from, to, y;
};

struct Strokes {
    std::vector<Stroke> all = {};
    double height = 0;  ///< of each row
};

/// Where there is ink, in square cells: a million lines above one another are no more of it than a few.
class Ink {
public:
    Ink(Box pixels, double cell);

    void line(Line line);  ///< what is outside of the sheet is left out
    /// Through how many cells lines have gone, the same one as often as a line went there.
    [[nodiscard]] double walked() const { return walked_; }
    /// Tells whether its cell was blank before.
    bool dot(Point point);

    /// What a round pen of this width leaves where there is ink. All in pixels.
    [[nodiscard]] Strokes strokes(double pen) const;

    /// The same in cells that are twice as wide and high.
    [[nodiscard]] Ink coarser() const;

private:
    struct Run {
        int begin, end;  // columns
    };
    [[nodiscard]] std::vector<std::vector<Run>> runs_of_rows() const;
    [[nodiscard]] std::size_t place(int column, int row) const;

    double cell_;
    int columns_, rows_;
    std::vector<bool> inked_;
    double walked_ = 0;
};

}  // namespace dinal::plots
