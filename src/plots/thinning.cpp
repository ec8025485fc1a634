#include "plots/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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
    constexpr double tolerance = 0.1;  // of a pixel; up to twice of that is lost
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
    Ink ink(paper.pixels, 1);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i) && ink.dot(project(i))) {
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

Strokes inked(const Curve& curve, const Paper& paper, double pen, std::size_t most) {
    constexpr double finest = 0.25;     // pixels: no printer shows that they are steps
    constexpr double most_cells = 2e7;  // of a large sheet
    // A million lines across the sheet leave it black in the coarsest cells, too, and sooner.
    constexpr double most_walked = 2e7;
    const double area = paper.pixels.width * paper.pixels.height;
    const Projected project(curve, paper);
    Ink ink(paper.pixels, std::max(finest, std::sqrt(area / most_cells)));
    bool down = false;
    Point last{};
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i)) {
            const Point point = project(i);
            if (down && curve.style != Style::points) {
                ink.line({last, point});
                if (ink.walked() > most_walked) ink = ink.coarser();
            } else {
                ink.dot(point);
            }
            last = point;
        }
        down = project.has(i);
    }
    Strokes strokes = ink.strokes(pen);
    while (strokes.all.size() > std::max<std::size_t>(most, 16)) {  // no more than 4 in the coarsest
        ink = ink.coarser();
        strokes = ink.strokes(pen);
    }
    return strokes;
}

std::vector<Strokes> crowded(const Curve& curve, const Paper& paper, std::size_t most) {
    constexpr double finest = 2, coarsest = 16;                   // pixels
    constexpr std::array<double, 4> within = {0, 0.4, 0.7, 0.9};  // of the cells that have points
    const Projected project(curve, paper);
    double cell = finest;
    while (true) {
        const auto columns = static_cast<std::size_t>(std::ceil(paper.pixels.width / cell));
        const auto rows = static_cast<std::size_t>(std::ceil(paper.pixels.height / cell));
        std::vector<std::size_t> counts(columns * rows, 0);
        for (std::size_t i = 0; i < curve.size(); ++i) {
            if (!project.has(i)) continue;
            const Point point = project(i);
            const double column = std::floor(point.x / cell), row = std::floor(point.y / cell);
            if (column >= 0 && row >= 0 && column < static_cast<double>(columns) && row < static_cast<double>(rows)) {
                ++counts[static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column)];
            }
        }
        std::vector<std::size_t> sorted = counts;
        std::erase(sorted, 0);
        std::sort(sorted.begin(), sorted.end());
        std::vector<Strokes> layers;
        std::size_t strokes = 0, before = 0;
        for (const double part : within) {
            const auto rank = static_cast<std::size_t>(part * static_cast<double>(sorted.size()));
            const std::size_t more_than = part == 0 || sorted.empty() ? 0 : sorted[rank];
            if (part > 0 && more_than == before) continue;
            before = more_than;
            Strokes layer{{}, cell};
            for (std::size_t place = 0; place < counts.size(); ++place) {
                if (counts[place] <= more_than) continue;
                const std::size_t column = place % columns, row = place / columns;
                const double from = static_cast<double>(column) * cell;
                const double y = (static_cast<double>(row) + 0.5) * cell;
                if (column > 0 && counts[place - 1] > more_than) {
                    layer.all.back().to = from + cell;
                } else {
                    layer.all.push_back({from, from + cell, y});
                }
            }
            strokes += layer.all.size();
            if (!layer.all.empty()) layers.push_back(std::move(layer));
        }
        if (strokes <= most || cell > coarsest) {
            return layers;
        }
        cell *= 1.25;
    }
}

}  // namespace dinal::plots
