#include "plots/thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace dinal::plots {
namespace {

class Projected {
public:
    Projected(const Curve& curve, const Paper& paper) : curve_(curve), paper_(paper) {}

    /// Returns whether the point exists: finite, and positive on logarithmic axes.
    bool has(std::size_t i) const {
        return paper_.view.x.has(curve_.x.values[i]) && paper_.view.y.has(curve_.y.values[i]) &&
               (!curve_.base || paper_.view.y.has(curve_.base->values[i]));
    }
    [[nodiscard]] Point operator()(std::size_t i) const {
        constexpr double far = 1e7;  // pixels; larger distances are clamped
        return {std::clamp(paper_.view.x(curve_.x.values[i]) * paper_.pixels.width, -far, far),
                std::clamp(paper_.view.y(curve_.y.values[i]) * paper_.pixels.height, -far, far)};
    }

private:
    const Curve& curve_;
    const Paper& paper_;
};

/// Drops points on straight parts, within the tolerance. From a corner, each point permits a range of directions of a
/// straight line; their intersection narrows with each point.
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
    /// Ends the piece; the next point begins another one.
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

/// The points drawn in one column of pixels.
struct ColumnOfPixels {
    static constexpr auto none = std::numeric_limits<std::size_t>::max();
    std::size_t first = none, last = none, lowest = none, highest = none;
    double low = 0, high = 0;

    void add(std::size_t i, double y) {
        if (first == none) {
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
        if (first == none) {
            return;
        }
        std::array<std::size_t, 4> points{first, lowest, highest, last};
        std::ranges::sort(points);
        const auto* end = std::unique(points.begin(), points.end());
        kept.insert(kept.end(), points.begin(), points.begin() + (end - points.begin()));
        first = none;
    }
};

std::vector<std::size_t> by_columns(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    std::vector<std::size_t> kept;
    ColumnOfPixels column;
    const double columns = std::ceil(paper.pixels.width);
    double current = 0;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) {
            column.flush(kept);
            kept.push_back(i);
            continue;
        }
        const double x = paper.view.x(curve.x.values[i]) * columns;
        // Everything left of the paper is one column, and everything right of it another.
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
    const double tolerance = 0.1;  // pixels; the error is at most twice this
    const Projected project(curve, paper);
    std::vector<std::size_t> corners;
    Corners piece(corners, tolerance);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (project.has(i)) {
            piece.add(i, project(i));
        } else {
            piece.finish();
            corners.push_back(i);
        }
    }
    piece.finish();
    return corners;
}

/// The first point in each pixel.
std::vector<std::size_t> by_pixels(const Curve& curve, const Paper& paper) {
    const Projected project(curve, paper);
    std::vector<std::size_t> kept;
    const auto columns = static_cast<std::size_t>(std::ceil(paper.pixels.width)) + 1;
    const auto rows = static_cast<std::size_t>(std::ceil(paper.pixels.height)) + 1;
    std::vector<bool> taken(columns * rows, false);
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (!project.has(i)) continue;
        const Point point = project(i);
        if (!(point.x >= 0 && point.y >= 0 && point.x <= paper.pixels.width && point.y <= paper.pixels.height))
            continue;
        const auto place = static_cast<std::size_t>(point.y) * columns + static_cast<std::size_t>(point.x);
        if (!taken[place]) kept.push_back(i);
        taken[place] = true;
    }
    return kept;
}

/// Returns whether it is a line or area with x that never decreases.
bool has_columns(const Curve& curve) {
    const auto x = curve.x.values.first(curve.size());
    double before = -std::numeric_limits<double>::infinity();
    return curve.style != Style::points && std::ranges::all_of(x, [&before](double value) {
               const bool falls = value < before;
               before = std::isnan(value) ? before : value;
               return !falls;
           });
}

}  // namespace

std::vector<std::size_t> thinned(const Curve& curve, const Paper& paper) {
    if (curve.style == Style::points) return by_pixels(curve, paper);
    std::vector<std::size_t> kept = has_columns(curve) ? by_columns(curve, paper) : by_corners(curve, paper);
    if (curve.base) {
        Curve other = curve;
        std::swap(other.y, *other.base);
        const std::vector<std::size_t> more = has_columns(other) ? by_columns(other, paper) : by_corners(other, paper);
        std::vector<std::size_t> both;
        std::set_union(kept.begin(), kept.end(), more.begin(), more.end(), std::back_inserter(both));
        kept = std::move(both);
    }
    return kept;
}

}  // namespace dinal::plots
