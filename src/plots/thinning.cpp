#include "plots/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace dinal::plots {
namespace {

constexpr double far = 1e7;  // pixels; what is further away is far enough

class Projected {
public:
    Projected(const Curve& curve, const Paper& paper) : curve_(curve), paper_(paper) {}

    [[nodiscard]] bool has(std::size_t i) const {
        return paper_.view.x.has(curve_.x.values[i]) && paper_.view.y.has(curve_.y.values[i]);
    }
    [[nodiscard]] Point operator()(std::size_t i) const {
        return {std::clamp(paper_.view.x(curve_.x.values[i]) * paper_.pixels.width, -far, far),
                std::clamp(paper_.view.y(curve_.y.values[i]) * paper_.pixels.height, -far, far)};
    }

private:
    const Curve& curve_;
    const Paper& paper_;
};

/// Leaves out the points between which the curve is straight to within the tolerance: from a corner, a point can be
/// reached by straight lines of a certain range of directions, and the range narrows with each point on the way.
class Corners {
public:
    Corners(std::vector<std::size_t>& kept, double tolerance) : kept_(kept), tolerance_(tolerance) {}

    void add(std::size_t i, Point point) {
        if (!open_) {
            begin(i, point);
            return;
        }
        const double dx = point.x - corner_.x;
        const double dy = point.y - corner_.y;
        const double distance = std::hypot(dx, dy);
        if (distance <= tolerance_ && reach_ <= tolerance_) {
            last_ = i;
            last_point_ = point;
            return;
        }
        const double direction = std::atan2(dy, dx);
        const double half = std::asin(std::min(1.0, tolerance_ / distance));
        const double turn = has_cone_ ? std::remainder(direction - middle_, 2 * std::numbers::pi) : 0;
        if (has_cone_ && (turn < low_ || turn > high_ || distance < reach_ - tolerance_)) {
            const std::size_t corner = last_;
            const Point corner_point = last_point_;
            begin(corner, corner_point);
            add(i, point);
            return;
        }
        if (!has_cone_) {
            has_cone_ = true;
            middle_ = direction;
            low_ = -half;
            high_ = half;
        } else {
            low_ = std::max(low_, turn - half);
            high_ = std::min(high_, turn + half);
        }
        reach_ = std::max(reach_, distance);
        last_ = i;
        last_point_ = point;
    }
    /// The piece ends here; the next point begins another one.
    void finish() {
        if (open_ && last_ != kept_.back()) {
            kept_.push_back(last_);
        }
        open_ = false;
    }

private:
    void begin(std::size_t i, Point point) {
        kept_.push_back(i);
        open_ = true;
        has_cone_ = false;
        corner_ = last_point_ = point;
        last_ = i;
        reach_ = 0;
    }

    std::vector<std::size_t>& kept_;
    double tolerance_;
    bool open_ = false;
    bool has_cone_ = false;
    Point corner_{}, last_point_{};
    std::size_t last_ = 0;
    double middle_ = 0, low_ = 0, high_ = 0, reach_ = 0;
};

/// A grid of square cells over the sheet, and how often each was touched: a million lines above one another are no more
/// ink than a few.
class Cells {
public:
    Cells(Box pixels, double size)
        : size_(size),
          columns_(static_cast<std::size_t>(std::ceil(pixels.width / size)) + 1),
          rows_(static_cast<std::size_t>(std::ceil(pixels.height / size)) + 1),
          counts_(columns_ * rows_, 0) {}

    /// Tells whether its cell was blank before.
    bool dot(Point point) {
        const double column = std::floor(point.x / size_), row = std::floor(point.y / size_);
        if (!(column >= 0 && row >= 0 && column < static_cast<double>(columns_) && row < static_cast<double>(rows_))) {
            return false;
        }
        return counts_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)]++ == 0;
    }

    /// What is outside of the sheet is left out.
    void line(Line line) {
        const Box sheet{static_cast<double>(columns_) * size_, static_cast<double>(rows_) * size_};
        if (!clip(line, sheet, 0)) return;
        const double dx = line.to.x - line.from.x, dy = line.to.y - line.from.y;
        const double steps = std::ceil(std::max(std::fabs(dx), std::fabs(dy)) / size_);
        walked_ += steps;
        for (int i = 0; i < static_cast<int>(steps); ++i) {
            const double part = i / steps;
            dot({line.from.x + part * dx, line.from.y + part * dy});
        }
        dot(line.to);
    }

    /// Through how many cells lines have gone, the same one as often as a line went there.
    [[nodiscard]] double walked() const { return walked_; }
    [[nodiscard]] double size() const { return size_; }

    /// The same in cells that are twice as wide and high.
    [[nodiscard]] Cells coarser() const {
        Cells result({static_cast<double>(columns_) * size_, static_cast<double>(rows_) * size_}, 2 * size_);
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            result.counts_[i / columns_ / 2 * result.columns_ + i % columns_ / 2] += counts_[i];
        }
        return result;
    }

    /// How often the part `fraction` of all inked cells was touched, or less often.
    [[nodiscard]] std::size_t quantile(double fraction) const {
        std::vector<std::size_t> sorted = counts_;
        std::erase(sorted, 0);
        if (sorted.empty()) return 0;
        std::sort(sorted.begin(), sorted.end());
        return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size()))];
    }

    /// The runs of cells that were touched more than so often.
    [[nodiscard]] Strokes touched_more_than(std::size_t count) const {
        Strokes strokes{{}, size_};
        for (std::size_t i = 0; i < counts_.size(); ++i) {
            if (counts_[i] <= count) continue;
            const double from = static_cast<double>(i % columns_) * size_;
            if (i % columns_ > 0 && counts_[i - 1] > count) {
                strokes.all.back().to = from + size_;
            } else {
                const auto row = i / columns_;
                strokes.all.push_back({from, from + size_, (static_cast<double>(row) + 0.5) * size_});
            }
        }
        return strokes;
    }

private:
    double size_;
    std::size_t columns_, rows_;
    std::vector<std::size_t> counts_;
    double walked_ = 0;
};

/// The points of one column of pixels that are drawn.
struct ColumnOfPixels {
    std::size_t first = gap, last = gap, lowest = gap, highest = gap;
    double low = 0, high = 0;

    void add(std::size_t i, double y) {
        if (first == gap) {
            *this = {i, i, i, i, y, y};
            return;
        }
        last = i;
        if (y < low) {
            low = y;
            lowest = i;
        }
        if (y > high) {
            high = y;
            highest = i;
        }
    }

    void flush(std::vector<std::size_t>& kept) {
        if (first == gap) {
            return;
        }
        std::array<std::size_t, 4> points{first, lowest, highest, last};
        std::sort(points.begin(), points.end());
        const auto* end = std::unique(points.begin(), points.end());
        kept.insert(kept.end(), points.begin(), points.begin() + (end - points.begin()));
        first = gap;
    }
};

void lift(std::vector<std::size_t>& kept) {
    if (!kept.empty() && kept.back() != gap) {
        kept.push_back(gap);
    }
}

std::vector<std::size_t> by_columns(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    std::vector<std::size_t> kept;
    ColumnOfPixels column;
    const double columns = std::ceil(paper.pixels.width / paper.coarseness);
    double current = 0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) {
            column.flush(kept);
            lift(kept);
            continue;
        }
        const double x = paper.view.x(curve.x.values[i]) * columns;
        // All that is left of the paper is one column, and so is all that is right of it.
        const double own = std::floor(std::clamp(x, -1.0, columns + 1));
        if (own != current) {
            column.flush(kept);
            current = own;
        }
        column.add(i, curve.y.values[i]);
    }
    column.flush(kept);
    return kept;
}

std::vector<std::size_t> by_corners(const Curve& curve, const Paper& paper) {
    const double tolerance = 0.1 * paper.coarseness;  // of a pixel; up to twice of that is lost
    const Projected project(curve, paper);
    std::vector<std::size_t> corners;
    Corners piece(corners, tolerance);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i)) {
            piece.add(i, project(i));
        } else {
            piece.finish();
            lift(corners);
        }
    }
    piece.finish();
    return corners;
}

std::vector<std::size_t> by_pixels(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    std::vector<std::size_t> kept;
    Cells cells(paper.pixels, paper.coarseness);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i) && cells.dot(project(i))) {
            kept.push_back(i);
        }
    }
    return kept;
}

}  // namespace

bool has_columns(const Curve& curve) {
    const auto x = curve.x.values.first(curve.size());
    double before = -std::numeric_limits<double>::infinity();
    return curve.style != Style::points && std::all_of(x.begin(), x.end(), [&before](double value) {
               const bool falls = value < before;
               before = std::isnan(value) ? before : value;
               return !falls;
           });
}

std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper) {
    if (curve.style == Style::points) {
        return by_pixels(curve, paper);
    }
    return has_columns(curve) ? by_columns(curve, paper) : by_corners(curve, paper);
}

std::vector<Strokes> inked(const Curve& curve, const Paper& paper, std::size_t most) {
    constexpr double finest = 1.3;      // pixels: half of what a line is wide
    constexpr double most_cells = 4e6;  // of a large sheet
    // A million lines across the sheet leave it black in the coarsest cells, too, and sooner.
    constexpr double most_walked = 2e7;
    constexpr std::size_t crowd = 10'000;                   // of points, whose ink alone would be solid blocks
    constexpr std::array<double, 3> denser{0.4, 0.7, 0.9};  // than this part of the cells that have points
    const bool cloud = curve.style == Style::points;
    const Projected project(curve, paper);
    Cells cells(paper.pixels, std::max(finest, std::sqrt(paper.pixels.width * paper.pixels.height / most_cells)));
    bool down = false;
    Point last{};
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i)) {
            const Point point = project(i);
            down && !cloud ? cells.line({last, point}) : static_cast<void>(cells.dot(point));
            if (cells.walked() > most_walked) cells = cells.coarser();
            last = point;
        }
        down = project.has(i);
    }
    while (true) {
        std::vector<Strokes> layers{cells.touched_more_than(0)};
        std::size_t strokes = layers.front().all.size(), before = 0;
        for (const double fraction : denser) {
            const std::size_t count = cloud && curve.size() > crowd ? cells.quantile(fraction) : 0;
            if (count == std::exchange(before, count)) continue;
            layers.push_back(cells.touched_more_than(count));
            strokes += layers.back().all.size();
            if (layers.back().all.empty()) layers.pop_back();
        }
        if (strokes <= std::max<std::size_t>(most, 16)) return layers;  // no more than 4 in the coarsest
        cells = cells.coarser();
    }
}

}  // namespace dinal::plots
