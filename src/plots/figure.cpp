#include "plots/figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "plots/shades.hpp"
#include "text/words.hpp"

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
    bool empty() const { return low > high; }
};

/// Extends y to the other edge of an area, its base or zero.
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

/// The extents of the visible points; limits of x select the points that determine the range of y.
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
    if (length <= 1e-12 * size || length < shortest_axis) {  // constant to rounding
        const double half = size > 10 * shortest_axis ? size / 10 : 1;
        return {middle - half, middle + half};
    }
    return {extent.low - air * length, extent.high + air * length};
}

Interval logarithmically_widened(Extent extent, double air) {
    if (extent.empty()) {
        return {1, 10};
    }
    const double decades = std::log10(extent.high) - std::log10(extent.low);  // the ratio itself may overflow
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

/// Centres a phase plane on the origin, unless the motion is far from it.
void include_origin(Extent& extent) {
    if (!extent.empty()) {
        Extent wider = extent;
        wider.add(0);
        if (wider.high - wider.low <= 3 * (extent.high - extent.low)) {
            extent = wider;
        }
    }
}

/// Gives a constant as much room as the other axis has, and a point as much as its distance from 0, for figures whose
/// axes have one unit.
void stretch_constants(Extents& all) {
    if (all.x.empty()) return;
    double half = std::max(all.x.high - all.x.low, all.y.high - all.y.low) / 2;
    if (half == 0) half = std::max(std::fabs(all.x.low), std::fabs(all.y.low));
    for (Extent* own : {&all.x, &all.y}) {
        if (own->low == own->high) *own = {own->low - half, own->high + half};
    }
}

}  // namespace

Scale::Scale(Interval range, bool logarithmic)
    : range_(range),
      logarithmic_(logarithmic),
      low_(logarithmic ? std::log10(range.low) : range.low),
      factor_(1 / ((logarithmic ? std::log10(range.high) : range.high) - low_)) {}

View view_of(const Figure& figure) {
    const bool has_points = text::contains(figure.curves, Style::points, &Curve::style);
    Extents extents = extents_of(figure);
    if (figure.circles) {
        include_origin(extents.x);
        include_origin(extents.y);
    }
    if (figure.equal) stretch_constants(extents);
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
        if (!text::contains(kinds, mark.kind)) {
            kinds.push_back(mark.kind);
        }
    }
    return kinds;
}

namespace {

/// The range of visible points of a curve.
struct Seen {
    std::size_t first = 0, last = 0;
};

Seen seen_in(const Figure& figure, const Curve& curve) {
    const Interval window = figure.x.limits.value_or(Interval{-infinity, infinity});
    const auto x = curve.x.values.first(curve.size());
    return {static_cast<std::size_t>(std::ranges::lower_bound(x, window.low) - x.begin()),
            static_cast<std::size_t>(std::ranges::upper_bound(x, window.high) - x.begin())};
}

/// The number of extremes in view; noise on a slow curve does not count if swings must exceed a part of the range.
std::size_t count_turns(const Curve& curve, const Seen& seen, double part) {
    if (seen.last <= seen.first) return 0;
    const auto y = curve.y.values.subspan(seen.first, seen.last - seen.first);
    Extent range;
    for (const double value : y) range.add(value);
    return turns_of(y, part > 0 ? part * (range.high - range.low) : 0).size() - 2;
}

/// A band of equal steps with the lowest and highest value in each.
Curve stepped_band(const Curve& curve, const Seen& seen, std::size_t steps) {
    const auto x = curve.x.values, y = curve.y.values;
    const double from = x[seen.first], length = x[seen.last - 1] - from;
    std::vector<double> middle(steps), low(steps, infinity), high(steps, -infinity);
    for (std::size_t i = seen.first; i < seen.last; ++i) {
        const auto step =
            std::min(steps - 1, static_cast<std::size_t>((x[i] - from) / length * static_cast<double>(steps)));
        low[step] = std::min(low[step], y[i]);
        high[step] = std::max(high[step], y[i]);
    }
    for (std::size_t step = 0; step < steps; ++step) {
        middle[step] = from + length * (static_cast<double>(step) + 0.5) / static_cast<double>(steps);
        if (low[step] > high[step]) low[step] = high[step] = std::nan("");
    }
    middle.front() = from;
    middle.back() = from + length;
    Curve band = curve;
    band.style = Style::fill;
    band.x = Numbers::own(std::move(middle));
    band.y = Numbers::own(std::move(high));
    band.base = Numbers::own(std::move(low));
    return band;
}

/// A vertical line in each place from the lowest to the highest value within one turn before and after it.
Curve envelope(const Curve& curve, const Seen& seen, std::size_t turns, std::size_t places) {
    const auto x = curve.x.values, y = curve.y.values;
    const double from = x[seen.first], length = x[seen.last - 1] - from;
    const double reach = length / static_cast<double>(turns);
    std::vector<double> across, up;
    std::size_t begin = seen.first;
    for (std::size_t place = 0; place < places; ++place) {
        const double middle = from + length * (static_cast<double>(place) + 0.5) / static_cast<double>(places);
        const double centre = std::clamp(middle, from + reach, from + length - reach);
        while (begin < seen.last && x[begin] < centre - reach) ++begin;
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = begin; i < seen.last && x[i] <= centre + reach; ++i) {
            low = std::min(low, y[i]);
            high = std::max(high, y[i]);
        }
        if (low > high) low = high = std::nan("");
        const double drawn_at = place == 0 ? from : place + 1 == places ? from + length : middle;
        for (const double end : {low, high}) {
            across.push_back(drawn_at);
            up.push_back(end);
        }
    }
    Curve all = curve;
    all.x = Numbers::own(std::move(across));
    all.y = Numbers::own(std::move(up));
    return all;
}

/// Calls replace(figure, curve, seen) for each line over increasing x, which may be too dense to be drawn.
template <class Replace>
std::vector<Figure> with_dense_lines(std::span<const Figure> figures, const Replace& replace) {
    std::vector<Figure> all(figures.begin(), figures.end());
    for (Figure& figure : all) {
        for (Curve& curve : figure.curves) {
            const bool over_x = std::ranges::is_sorted(curve.x.values.first(curve.size()));
            if (curve.style == Style::line && over_x) replace(figure, curve, seen_in(figure, curve));
        }
    }
    return all;
}

}  // namespace

std::vector<std::size_t> turns_of(std::span<const double> y, double smallest) {
    std::vector<std::size_t> turns{0};
    std::size_t low = 0, high = 0;  // since the last turn
    int direction = 0;
    for (std::size_t i = 0; i < y.size(); ++i) {
        low = y[i] < y[low] ? i : low;
        high = y[i] > y[high] ? i : high;
        const bool down = direction >= 0 && y[i] < y[high] - smallest, up = direction <= 0 && y[i] > y[low] + smallest;
        if (!down && !up) continue;
        if (direction != 0) turns.push_back(down ? high : low);
        direction = down ? -1 : 1;
        low = high = i;
    }
    turns.push_back(y.size() - 1);
    return turns;
}

std::vector<Figure> with_envelopes(std::span<const Figure> figures, double width) {
    return with_dense_lines(figures, [width](const Figure& figure, Curve& curve, const Seen& seen) {
        constexpr double closest = 2.5;  // distance between extremes, in units of the width
        constexpr double good_part = 0.1;
        const std::size_t turns = figure.x.logarithmic ? 0 : count_turns(curve, seen, good_part);
        if (static_cast<double>(turns) * closest > width) {
            curve = envelope(curve, seen, turns, static_cast<std::size_t>(width));
        }
    });
}

std::vector<Figure> with_bands(std::span<const Figure> figures, double width) {
    return with_dense_lines(figures, [width](const Figure& /*figure*/, Curve& curve, const Seen& seen) {
        constexpr double closest = 3, turns_to_a_step = 4;  // distance between extremes, in units of the width
        const auto turns = static_cast<double>(curve.behind ? count_turns(curve, seen, 0) : 0);
        if (turns * closest <= width) return;
        const double steps = std::clamp(turns / turns_to_a_step, 2.0, width);
        curve = stepped_band(curve, seen, static_cast<std::size_t>(steps));
    });
}

std::vector<std::size_t> drawing_order(const Figure& figure) {
    std::vector<std::size_t> order;
    for (const bool behind : {true, false}) {
        for (std::size_t i = 0; i < figure.curves.size(); ++i) {
            if (figure.curves[i].behind == behind) order.push_back(i);
        }
    }
    return order;
}

bool clip(Line& line, Box sheet, double slack) {
    const Point from = line.from;
    const double dx = line.to.x - from.x;
    const double dy = line.to.y - from.y;
    double begin = 0;
    double end = 1;
    const std::array<std::array<double, 2>, 4> sides{{{-dx, from.x + slack},
                                                      {dx, sheet.width + slack - from.x},
                                                      {-dy, from.y + slack},
                                                      {dy, sheet.height + slack - from.y}}};
    for (const auto& [direction, distance] : sides) {
        if (direction == 0) {
            if (distance < 0) {
                return false;
            }
        } else if (direction < 0) {
            begin = std::max(begin, distance / direction);
        } else {
            end = std::min(end, distance / direction);
        }
    }
    if (!(begin <= end)) {
        return false;
    }
    line = {{from.x + begin * dx, from.y + begin * dy}, {from.x + end * dx, from.y + end * dy}};
    return true;
}

}  // namespace dinal::plots
