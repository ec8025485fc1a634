#include "plots/figure.hpp"

#include <algorithm>
#include <limits>

#include "plots/shades.hpp"

namespace dinal::plots {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Extent {
    double low = infinity;
    double high = -infinity;
    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    void add(const Extent& other) {
        low = std::min(low, other.low);
        high = std::max(high, other.high);
    }
    [[nodiscard]] bool empty() const { return low > high; }
};

/// An area reaches to its base, or to zero.
void add_other_edge(const Curve& curve, Interval window, bool logarithmic, Extent& y) {
    if (!curve.base) {
        if (!logarithmic) {
            y.add(0);
        }
        return;
    }
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double x = curve.x.values[i];
        if (drawable(curve.base->values[i], logarithmic) && x >= window.low && x <= window.high) {
            y.add(curve.base->values[i]);
        }
    }
}

struct Extents {
    Extent x, y;
};

/// Of the points that are seen: who looks at a piece of time wants to see the values of that piece.
Extents extents_of(const Figure& figure) {
    const Interval window = figure.x.limits.value_or(Interval{-infinity, infinity});
    const bool x_log = figure.x.logarithmic, y_log = figure.y.logarithmic;
    Extents all;
    if (figure.shades != nullptr) {
        for (const double x : edges_between(figure.shades->x, x_log)) all.x.add(x);
        for (const double y : edges_between(figure.shades->y, y_log)) all.y.add(y);
        return all;
    }
    for (const Curve& curve : figure.curves) {
        const double* xs = curve.x.values.data();
        const double* ys = curve.y.values.data();
        Extents own;
        for (std::size_t i = 0, n = curve.size(); i < n; ++i) {
            if (drawable(xs[i], x_log) && drawable(ys[i], y_log) && xs[i] >= window.low && xs[i] <= window.high) {
                own.x.add(xs[i]);
                own.y.add(ys[i]);
            }
        }
        if (curve.style == Style::fill && !own.x.empty()) {
            add_other_edge(curve, window, y_log, own.y);
        }
        all.x.add(own.x);
        all.y.add(own.y);
    }
    return all;
}

Interval widened(Extent extent, double air) {
    if (extent.empty()) {
        return {0, 1};
    }
    const double middle = extent.low / 2 + extent.high / 2;
    const double size = std::max(std::fabs(extent.low), std::fabs(extent.high));
    const double length = extent.high - extent.low;
    if (length <= 1e-12 * size || length < shortest_axis) {  // a constant, or what differs from one by roundings
        const double half = size > 10 * shortest_axis ? size / 10 : 1;
        return {middle - half, middle + half};
    }
    return {extent.low - air * length, extent.high + air * length};
}

Interval logarithmically_widened(Extent extent, double air) {
    if (extent.empty()) {
        return {1, 10};
    }
    const double decades = std::log10(extent.high) - std::log10(extent.low);  // of the ratio, which may overflow
    const double factor = std::pow(10, decades < 1e-9 ? 0.5 : air * decades);
    return {std::max(extent.low / factor, std::numeric_limits<double>::denorm_min()),
            std::min(extent.high * factor, std::numeric_limits<double>::max())};
}

Interval with_air(Extent extent, const Axis& axis, double air) {
    if (axis.limits) {
        return *axis.limits;
    }
    return axis.logarithmic ? logarithmically_widened(extent, air) : widened(extent, air);
}

/// The origin is the middle of a phase plane, unless the motion is far from it.
void include_origin(Extent& extent) {
    if (!extent.empty()) {
        Extent wider = extent;
        wider.add(0);
        if (wider.high - wider.low <= 3 * (extent.high - extent.low)) {
            extent = wider;
        }
    }
}

}  // namespace

Scale::Scale(Interval range, bool logarithmic)
    : range_(range),
      logarithmic_(logarithmic),
      low_(logarithmic ? std::log10(range.low) : range.low),
      factor_(1 / ((logarithmic ? std::log10(range.high) : range.high) - low_)) {}

View view_of(const Figure& figure) {
    const bool has_points = std::any_of(figure.curves.begin(), figure.curves.end(),
                                        [](const Curve& curve) { return curve.style == Style::points; });
    Extents extents = extents_of(figure);
    if (figure.circles) {
        include_origin(extents.x);
        include_origin(extents.y);
    }
    const bool is_map = figure.shades != nullptr;
    return {
        Scale(with_air(extents.x, figure.x, !is_map && (figure.equal || has_points) ? 0.06 : 0), figure.x.logarithmic),
        Scale(with_air(extents.y, figure.y, is_map ? 0 : 0.05), figure.y.logarithmic)};
}

Box equal_box(View& view, Box most) {
    const double thinnest = 0.25 * std::max(most.width, most.height);
    const auto unit = [&] {
        return std::min(most.width / view.x.range().length(), most.height / view.y.range().length());
    };
    const auto widen = [](Scale& scale, double length) {
        const double more = (length - scale.range().length()) / 2;
        if (more > 0) {
            scale = Scale({scale.range().low - more, scale.range().high + more}, false);
        }
    };
    const double length = thinnest / unit();
    widen(view.x, length);
    widen(view.y, length);
    return {unit() * view.x.range().length(), unit() * view.y.range().length()};
}

std::vector<MarkKind> kinds_of(const std::vector<Mark>& marks) {
    std::vector<MarkKind> kinds;
    for (const Mark& mark : marks) {
        if (std::find(kinds.begin(), kinds.end(), mark.kind) == kinds.end()) {
            kinds.push_back(mark.kind);
        }
    }
    return kinds;
}

}  // namespace dinal::plots
