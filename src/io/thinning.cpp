#include "io/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/pen_path.hpp"

namespace dinal {
namespace {

constexpr double far = 1e5;  // pixels; what is further away is far enough

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

bool never_falls(const Curve& curve) {
    const auto x = curve.x.values.first(curve.size());
    double before = -std::numeric_limits<double>::infinity();
    for (const double value : x) {
        if (value < before) {
            return false;
        }
        before = std::isnan(value) ? before : value;
    }
    return true;
}

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

/// The points that no other one outdoes: drawn whatever else is left out.
std::array<std::size_t, 4> extremes(const Curve& curve, const Projected& project) {
    std::array<std::size_t, 4> found{gap, gap, gap, gap};
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) {
            continue;
        }
        const auto better = [&](std::size_t which, bool yes) {
            if (found[which] == gap || yes) {
                found[which] = i;
            }
        };
        const auto x = [&](std::size_t which) { return curve.x.values[found[which] == gap ? i : found[which]]; };
        const auto y = [&](std::size_t which) { return curve.y.values[found[which] == gap ? i : found[which]]; };
        better(0, curve.x.values[i] < x(0));
        better(1, curve.x.values[i] > x(1));
        better(2, curve.y.values[i] < y(2));
        better(3, curve.y.values[i] > y(3));
    }
    return found;
}

/// Leaves out the lines that would only paint over ink that is there.
template <class Predicate>
std::vector<std::size_t> without_repainting(const std::vector<std::size_t>& corners, const Projected& project,
                                            const Paper& paper, const Predicate& is_forced) {
    Painted painted(paper.pixels, paper.coarseness);
    std::vector<std::size_t> kept;
    for (std::size_t n = 0; n < corners.size(); ++n) {
        const std::size_t i = corners[n];
        const bool starts = n == 0 || corners[n - 1] == gap;
        if (i == gap || starts) {
            i == gap ? lift(kept) : kept.push_back(i);
            continue;
        }
        if (painted.line(project(corners[n - 1]), project(i)) || is_forced(i) || is_forced(corners[n - 1])) {
            if (kept.empty() || kept.back() != corners[n - 1]) {
                lift(kept);
                kept.push_back(corners[n - 1]);
            }
            kept.push_back(i);
        }
    }
    return kept;
}

std::vector<std::size_t> by_corners(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    const auto forced = extremes(curve, project);
    const auto is_forced = [&forced](std::size_t i) {
        return std::find(forced.begin(), forced.end(), i) != forced.end();
    };
    std::vector<std::size_t> corners;
    Corners piece(corners, std::min(0.5, 0.2 * paper.coarseness));
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) {
            piece.finish();
            lift(corners);
            continue;
        }
        piece.add(i, project(i));
        if (is_forced(i)) {
            piece.finish();
            piece.add(i, project(i));
            corners.pop_back();
        }
    }
    piece.finish();

    return paper.coarseness > 1 ? without_repainting(corners, project, paper, is_forced) : corners;
}

/// Points that are not joined: the first on each pixel of those that are seen.
std::vector<std::size_t> by_pixels(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    const double columns = std::floor(paper.pixels.width / paper.coarseness) + 1;
    const double rows = std::floor(paper.pixels.height / paper.coarseness) + 1;
    std::vector<bool> taken(static_cast<std::size_t>(columns * rows), false);
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) {
            continue;
        }
        const Point point = project(i);
        const double column = std::floor(point.x / paper.coarseness);
        const double row = std::floor(point.y / paper.coarseness);
        if (column < 0 || row < 0 || column >= columns || row >= rows) {
            continue;
        }
        const auto pixel = static_cast<std::size_t>(row * columns + column);
        if (!taken[pixel]) {
            taken[pixel] = true;
            kept.push_back(i);
        }
    }
    return kept;
}

}  // namespace

std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper) {
    if (curve.style == Style::points) {
        return by_pixels(curve, paper);
    }
    return never_falls(curve) ? by_columns(curve, paper) : by_corners(curve, paper);
}

}  // namespace dinal
