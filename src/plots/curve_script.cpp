#include "plots/curve_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plots/paper_style.hpp"

namespace dinal::plots {
namespace {

using Columns = std::vector<std::vector<double>>;
using Places = std::vector<std::size_t>;

std::vector<Places> pieces_of(const Places& places) {
    std::vector<Places> pieces;
    bool open = false;
    for (const std::size_t place : places) {
        if (place != gap && !open) {
            pieces.emplace_back();
        }
        open = place != gap;
        if (open) {
            pieces.back().push_back(place);
        }
    }
    return pieces;
}

/// gnuplot loses lines that come from very far outside of the box. They are nearly straight above or beside it.
double in_reach(const Scale& scale, double value) {
    constexpr double reach = 1e3;  // lengths of the axis
    const double place = scale(value);
    return std::fabs(place) > reach ? scale.at(std::copysign(reach, place)) : value;
}

Columns columns_of(const PaperPanel& panel, const Curve& curve, const Places& places) {
    Columns columns(2);
    for (const std::size_t place : places) {
        columns[0].push_back(place == gap ? std::nan("") : in_reach(panel.view.x, curve.x.values[place]));
        columns[1].push_back(place == gap ? std::nan("") : in_reach(panel.view.y, curve.y.values[place]));
    }
    return columns;
}

/// As vectors: where one line ends and the next begins, gnuplot's pngcairo draws spikes.
Columns columns_of(const PaperPanel& panel, const std::vector<Stroke>& strokes) {
    Columns columns(4);
    const double width = panel.right - panel.left;
    for (const Stroke& stroke : strokes) {
        const double from = panel.view.x.at(stroke.from / width);
        columns[0].push_back(from);
        columns[1].push_back(panel.view.y.at(stroke.y / (panel.top - panel.bottom)));
        columns[2].push_back(panel.view.x.at(stroke.to / width) - from);
        columns[3].push_back(0);
    }
    return columns;
}

std::string stroke_element(const PaperPanel& panel, const Strokes& strokes, double overlap, const std::string& colour,
                           GnuplotData& data) {
    return fmt::format("{} with vectors nohead lt 1 dt 1 lw {:.3f} lc rgb '{}'",
                       data.add(columns_of(panel, strokes.all)), overlap * strokes.height, colour);
}

bool is_dot(const PaperPanel& panel, const Curve& curve, const Places& piece) {
    const auto near = [](double a, double b, double pixels) { return std::fabs(a - b) * pixels < line_width; };
    return std::all_of(piece.begin(), piece.end(), [&](std::size_t place) {
        return near(panel.view.x(curve.x.values[place]), panel.view.x(curve.x.values[piece.front()]),
                    panel.right - panel.left) &&
               near(panel.view.y(curve.y.values[place]), panel.view.y(curve.y.values[piece.front()]),
                    panel.top - panel.bottom);
    });
}

/// A piece that is no longer than a dot would leave no ink as a line.
std::vector<std::string> line_elements(const PaperPanel& panel, std::size_t i, const Places& places,
                                       GnuplotData& data) {
    const Curve& curve = panel.figure->curves[i];
    Places dots, lines;
    for (const Places& piece : pieces_of(places)) {
        if (is_dot(panel, curve, piece)) {
            dots.push_back(piece.front());
        } else {
            lines.insert(lines.end(), piece.begin(), piece.end());
            lines.push_back(gap);
        }
    }
    std::vector<std::string> elements;
    if (!lines.empty()) {
        lines.pop_back();
        elements.push_back(data.add(columns_of(panel, curve, lines)) + " with lines " + line_style(*panel.figure, i));
    }
    if (!dots.empty()) {
        elements.push_back(data.add(columns_of(panel, curve, dots)) + " with points " + dot_style(*panel.figure, i));
    }
    return elements;
}

/// The part of a polygon where distance(point) >= 0 (Sutherland and Hodgman).
template <class Distance>
std::vector<Point> cut(const std::vector<Point>& corners, const Distance& distance) {
    std::vector<Point> kept;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Point& a = corners[i];
        const Point& b = corners[(i + 1) % corners.size()];
        const double from = distance(a);
        const double to = distance(b);
        if (from >= 0) {
            kept.push_back(a);
        }
        if ((from < 0) != (to < 0)) {
            const double part = from / (from - to);
            kept.push_back({a.x + part * (b.x - a.x), a.y + part * (b.y - a.y)});
        }
    }
    return kept;
}

/// The area of one piece, in fractions of the axes.
// NOTE: gnuplot's pngcairo cuts areas wrongly that reach out of the box.
std::vector<Point> area_in_box(const View& view, const Curve& curve, const Places& piece) {
    const auto corner = [&view, &curve](std::size_t place, double y) {
        constexpr double far = 1e6;
        return Point{std::clamp(view.x(curve.x.values[place]), -far, far), std::clamp(view.y(y), -far, far)};
    };
    const double zero = view.y.logarithmic() ? view.y.range().low : 0;
    std::vector<Point> corners;
    for (const std::size_t place : piece) {
        corners.push_back(corner(place, curve.y.values[place]));
    }
    for (auto place = piece.rbegin(); place != piece.rend(); ++place) {
        corners.push_back(corner(*place, curve.base ? curve.base->values[*place] : zero));
    }
    corners = cut(corners, [](Point point) { return point.x; });
    corners = cut(corners, [](Point point) { return 1 - point.x; });
    corners = cut(corners, [](Point point) { return point.y; });
    return cut(corners, [](Point point) { return 1 - point.y; });
}

/// NaN would close an area where it opens: each piece is drawn for itself.
std::vector<std::string> fill_elements(const PaperPanel& panel, std::size_t i, const Places& places,
                                       GnuplotData& data) {
    std::vector<std::string> elements;
    for (const Places& piece : pieces_of(places)) {
        Columns columns(2);
        for (const Point& corner : area_in_box(panel.view, panel.figure->curves[i], piece)) {
            columns[0].push_back(panel.view.x.at(corner.x));
            columns[1].push_back(panel.view.y.at(corner.y));
        }
        if (!columns.front().empty()) {
            elements.push_back(data.add(columns) + " with filledcurves closed " + fill_style(*panel.figure, i));
        }
    }
    return elements;
}

}  // namespace

std::vector<std::string> curve_elements(const PaperPanel& panel, std::size_t place, const Trace& trace,
                                        GnuplotData& data) {
    const Curve& curve = panel.figure->curves[place];
    if (!trace.ink.all.empty()) {
        constexpr double overlap = 1.6;  // or a screen shows the seams between rows
        return {stroke_element(panel, trace.ink, overlap, colour_of(*panel.figure, place), data)};
    }
    if (!trace.layers.empty()) {
        constexpr double overlap = 1.2;   // the seams show the layer below
        constexpr double faintest = 0.4;  // that is still seen
        std::vector<std::string> elements;
        double above = static_cast<double>(trace.layers.size());
        for (const Strokes& layer : trace.layers) {
            const double strength =
                1 - (1 - faintest) * --above / std::max(1.0, static_cast<double>(trace.layers.size()) - 1);
            elements.push_back(stroke_element(panel, layer, overlap, tint_of(*panel.figure, place, strength), data));
        }
        return elements;
    }
    if (curve.style == Style::fill) {
        return fill_elements(panel, place, trace.places, data);
    }
    if (curve.style == Style::line) {
        return line_elements(panel, place, trace.places, data);
    }
    if (trace.places.empty()) {
        return {};
    }
    return {data.add(columns_of(panel, curve, trace.places)) + " with points " + point_style(*panel.figure, place)};
}

}  // namespace dinal::plots
