#include "plots/gnuplot_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "plots/figure.hpp"
#include "plots/paper_layout.hpp"
#include "plots/shades.hpp"
#include "plots/thinning.hpp"
#include "text/characters.hpp"

namespace dinal::plots {

namespace {

// ---- How things look on paper, as gnuplot is told: colours, dashes, marks.

/// How broad a line is, in pixels of 1/96 inch.
constexpr double line_width = 1.3;

constexpr std::string_view ink_colour = "#444444";  // of words, axes and marks

constexpr std::string_view dead_zone_colour = "#B0B0B0";  // and the motion is drawn over it

// Okabe and Ito's colours, which the colour-blind tell apart, without the yellow, which paper swallows.
constexpr std::array<std::string_view, 7> palette{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#000000", "#E69F00", "#56B4E9"};
// Another length of this list than of that one: the pair repeats after 42 curves only.
constexpr std::array<std::string_view, 6> dash_types{"1", "(11,4)", "(2,3)", "(11,3,2,3)", "(6,3)", "(11,3,2,3,2,3)"};

std::string_view dash_type(Dashes dashes, std::size_t curve) {
    switch (dashes) {
        case Dashes::solid:
            return dash_types[0];
        case Dashes::dashed:
            return dash_types[1];
        case Dashes::dotted:
            return dash_types[2];
        case Dashes::dash_dotted:
            return dash_types[3];
        case Dashes::by_place:
            break;
    }
    return dash_types[curve % dash_types.size()];
}

// The figure's curve of that place, from 0:
std::string colour_of(const Figure& figure, std::size_t curve) {
    const int own = figure.curves[curve].colour;
    return std::string(palette[(own > 0 ? static_cast<std::size_t>(own - 1) : curve) % palette.size()]);
}

/// The same, paler: 1 is full, 0 white.
std::string tint_of(const Figure& figure, std::size_t curve, double strength) {
    const auto full = static_cast<unsigned>(std::stoul(colour_of(figure, curve).substr(1), nullptr, 16));
    unsigned tint = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double paper = 255, own = (full >> shift) & 255U;
        tint |= static_cast<unsigned>(paper + strength * (own - paper)) << shift;
    }
    return fmt::format("#{:06X}", tint);
}

std::string line_style(const Figure& figure, std::size_t curve) {
    return fmt::format("lt 1 lw {} dt {} lc rgb '{}'", line_width, dash_type(figure.curves[curve].dashes, curve),
                       colour_of(figure, curve));
}

std::string point_style(const Figure& figure, std::size_t curve) {
    constexpr std::array<int, 5> shapes{6, 2, 8, 4, 1};  // circle, x, triangle, square, +
    constexpr std::size_t crowd = 500;                   // in which shapes would hide each other
    if (figure.curves[curve].size() > crowd) return fmt::format("pt 7 ps 0.12 lc rgb '{}'", colour_of(figure, curve));
    return fmt::format("pt {} ps 0.45 lw 0.6 lc rgb '{}'", shapes[curve % shapes.size()], colour_of(figure, curve));
}

std::string fill_style(const Figure& figure, std::size_t curve) {
    constexpr double density = 0.25;
    return fmt::format("fc rgb '{}' fs transparent solid {} noborder", colour_of(figure, curve), density);
}

/// Of a dot, which must be broader than a line to be seen.
std::string dot_style(const Figure& figure, std::size_t curve) {
    return fmt::format("pt 7 ps 0.35 lc rgb '{}'", colour_of(figure, curve));
}

std::string mark_style(MarkKind kind) {
    constexpr std::array<int, 4> shapes = {6, 7, 13, 12};  // circles, and diamonds for events
    return fmt::format("pt {} ps 0.7 lw 0.8 lc rgb '{}'", shapes[static_cast<std::size_t>(kind)], ink_colour);
}

/// What is drawn of a curve.
struct Trace {
    std::vector<std::size_t> places = {};  ///< of its points, `gap` where the pen is lifted
    std::vector<Strokes> layers = {};      ///< or in their place; in pixels of the sheet from the corner of the box
};
using Selection = std::vector<Trace>;  ///< one for each curve

// ---- curves

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

/// In the order in which they are to be drawn, for the panel's curve of that place.
std::vector<std::string> curve_elements(const PaperPanel& panel, std::size_t place, const Trace& trace,
                                        GnuplotData& data) {
    const Curve& curve = panel.figure->curves[place];
    if (!trace.layers.empty()) {
        const double overlap = trace.layers.size() > 1 ? 1.2 : 1.6;  // or the seams between rows show what is below
        constexpr double faintest = 0.4;                             // that is still seen
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

// ---- a panel

constexpr double bar = 0.3 * em;           // how high the bars are for the dead zone and for what is stuck
constexpr double below_ticks = 0.45 * em;  // how far those for what is stuck are from the axis

class PanelScript {
public:
    PanelScript(const Sheet& sheet, const PaperPanel& panel, const Selection& kept, GnuplotData& data)
        : sheet_(sheet), panel_(panel), figure_(*panel.figure), kept_(kept), data_(data) {}

    std::string text() {
        add_box();
        add_axis('x', panel_.view.x, panel_.x_ticks);
        add_axis('y', panel_.view.y, panel_.y_ticks);
        add_legend();
        add_colour_bar();
        add_stuck();
        if (figure_.dead_zone) {
            add_dead_zone();
        }
        add_shades();
        add_circles();
        add_curves();
        if (elements_.empty()) {
            line(fmt::format("set label '(no points)' at graph 0.5,0.5 center textcolor rgb '{}'", ink_colour));
            elements_.emplace_back("NaN");
        }
        return text_ + fmt::format("plot \\\n  {} notitle\n", fmt::join(elements_, " notitle, \\\n  "));
    }

private:
    void line(const std::string& command) { text_ += command + '\n'; }

    void add_box() {
        line("reset");
        line(fmt::format("set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}", panel_.left / sheet_.width,
                         panel_.right / sheet_.width));
        line(fmt::format("set bmargin at screen {:.5f}\nset tmargin at screen {:.5f}", panel_.bottom / sheet_.height,
                         panel_.top / sheet_.height));
        line("set clip two");
        if (!figure_.axes) {
            line("unset border");
        } else {
            line(fmt::format("set border 3 lt 1 lw 0.8 lc rgb '{}'", ink_colour));
            line("set grid xtics ytics back lt 1 lw 0.5 lc rgb '#E4E4E4'");
        }
        if (figure_.axes && !panel_.view.y.logarithmic()) {
            line("set xzeroaxis lt 1 lw 0.7 lc rgb '#A0A0A0'");
        }
        if (figure_.axes && figure_.circles) {
            line("set yzeroaxis lt 1 lw 0.7 lc rgb '#A0A0A0'");
        }
        line("unset key");
        add_words(panel_.title, "");
        if (figure_.axes) {
            add_words(panel_.x_label, "");
            add_words(panel_.y_label, " rotate by 90");
        }
    }

    /// On the sheet, as gnuplot wants it: in fractions of its width and height.
    [[nodiscard]] std::string at(double x, double y) const {
        return fmt::format("screen {:.5f},{:.5f}", x / sheet_.width, y / sheet_.height);
    }

    // NOTE: not by `set xlabel`, which stands elsewhere on each kind of sheet.
    void add_words(const Words& words, std::string_view how) {
        if (!words.text.empty()) {
            line(fmt::format("set label {} at {} center{} textcolor rgb '{}'", quoted_words(words.text),
                             at(words.x, words.y), how, ink_colour));
        }
    }

    void add_axis(char name, const Scale& scale, const Ticks& ticks) {
        // NOTE: a tick on the very end of a logarithmic axis is lost to gnuplot's roundings.
        constexpr double hair = 1e-9;
        const double low = scale.range().low * (scale.logarithmic() ? 1 - hair : 1);
        const double high = std::min(scale.range().high * (scale.logarithmic() ? 1 + hair : 1), 1.7e308);
        line(fmt::format("set {}range [{}:{}]", name, low, high));
        if (scale.logarithmic()) {
            line(fmt::format("set logscale {}", name));
        }
        if (!figure_.axes) {
            line(fmt::format("unset {}tics", name));
            return;
        }
        std::vector<std::string> list;
        for (std::size_t i = 0; i < ticks.at.size(); ++i) {
            list.push_back(fmt::format("'{}' {}", typeset(ticks.text[i]), std::clamp(ticks.at[i], low, high)));
        }
        line(fmt::format("set {}tics nomirror out scale 0.5 offset {} textcolor rgb '{}' ({})", name,
                         name == 'y'             ? "0.5,0"
                         : figure_.stuck.empty() ? "0,0.3"
                                                 : "0,-0.2",
                         ink_colour, fmt::join(list, ", ")));
    }

    void add_legend() {
        for (const LegendEntry& entry : panel_.legend) {
            const double width = sample_width(entry.sample);
            line(fmt::format("set label {} at {} left textcolor rgb '{}'", quoted_words(entry.text),
                             at(entry.x + width + after_sample, entry.y), ink_colour));
            switch (entry.sample) {
                case Sample::mark:
                    add_sample_point(entry, mark_style(static_cast<MarkKind>(entry.curve)));
                    break;
                case Sample::dead_zone:
                    add_bar(at(entry.x, entry.y - bar / 2), at(entry.x + width, entry.y + bar / 2), dead_zone_colour);
                    break;
                case Sample::stuck:
                    add_bar(at(entry.x, entry.y - bar / 2), at(entry.x + width, entry.y + bar / 2), ink_colour);
                    break;
                case Sample::curve:
                    add_sample_of_curve(entry);
                    break;
                case Sample::none:
                    break;
            }
        }
    }

    void add_colour_bar() {
        const ColourBar& colours = panel_.bar;
        const double cell = (panel_.top - panel_.bottom) / std::max(1.0, static_cast<double>(colours.cells));
        for (std::size_t i = 0; i < colours.cells; ++i) {
            const double y = panel_.bottom + static_cast<double>(i) * cell;
            add_bar(at(colours.left, y), at(colours.right, y + cell), shade_colour(i, colours.cells));
        }
        for (const auto& [place, text] : colours.labels) {
            line(fmt::format("set label {} at {} left textcolor rgb '{}'", quoted_words(text),
                             at(colours.right + 0.4 * em, panel_.bottom + place * cell), ink_colour));
        }
        add_words(panel_.bar_label, " rotate by 90");
    }

    void add_sample_of_curve(const LegendEntry& entry) {
        const double end = entry.x + sample_width(entry.sample);
        const Style style = figure_.curves[entry.curve].style;
        if (style == Style::points) {
            add_sample_point(entry, point_style(figure_, entry.curve));
        } else if (style == Style::fill) {
            line(fmt::format("set object rectangle from {} to {} {}", at(entry.x, entry.y - 0.35 * em),
                             at(end, entry.y + 0.35 * em), fill_style(figure_, entry.curve)));
        } else {
            line(fmt::format("set arrow from {} to {} nohead {}", at(entry.x, entry.y), at(end, entry.y),
                             line_style(figure_, entry.curve)));
        }
    }

    void add_sample_point(const LegendEntry& entry, const std::string& style) {
        line(fmt::format("set label '' at {} point {}", at(entry.x + sample_width(entry.sample) / 2, entry.y), style));
    }

    void add_bar(const std::string& from, const std::string& to, std::string_view colour) {
        line(fmt::format("set object rectangle from {} to {} fc rgb '{}' fs solid noborder", from, to, colour));
    }

    /// Bars below the ticks of the time axis; thousands of stops that no eye parts become one.
    void add_stuck() {
        const Interval seen = panel_.view.x.range();
        const double finest = seen.length() / (2 * (panel_.right - panel_.left));
        Interval all{seen.high, seen.high};
        const auto draw = [&] {
            if (all.high > all.low) {
                const double top = panel_.bottom - below_ticks;
                add_bar(fmt::format("first {}, screen {:.5f}", all.low, (top - bar) / sheet_.height),
                        fmt::format("first {}, screen {:.5f}", all.high, top / sheet_.height), ink_colour);
            }
        };
        for (const Interval& span : figure_.stuck) {
            const double low = std::max(span.low, seen.low);
            const double high = std::min(std::max(span.high, low + finest), seen.high);
            if (low > high) {
                continue;
            }
            if (low - all.high <= finest && all.high > all.low) {
                all.high = std::max(all.high, high);
                continue;
            }
            draw();
            all = {low, high};
        }
        draw();
    }

    void add_dead_zone() {
        const Interval seen = panel_.view.x.range();
        const double half = panel_.view.y.range().length() * (bar / 2) / (panel_.top - panel_.bottom);
        const double low = std::max(figure_.dead_zone->low, seen.low);
        const double high = std::min(figure_.dead_zone->high, seen.high);
        if (low < high) {
            add_bar(fmt::format("{}, {}", low, -half), fmt::format("{}, {}", high, half), dead_zone_colour);
        }
    }

    void add_circles() {
        std::vector<double> x, y;
        for (const double radius : circles_of(figure_, panel_.x_ticks, panel_.y_ticks)) {
            constexpr int corners = 120;
            for (int i = 0; i <= corners; ++i) {
                const double angle = 2 * std::numbers::pi * i / corners;
                x.push_back(radius * std::cos(angle));
                y.push_back(radius * std::sin(angle));
            }
            x.push_back(std::nan(""));
            y.push_back(std::nan(""));
        }
        if (!x.empty()) {
            elements_.push_back(data_.add({x, y}) + " with lines lt 1 lw 0.6 lc rgb '#C8C8C8'");
        }
    }

    /// Boxes, a little larger than they are: else a screen shows the seams between them.
    void add_shades() {
        if (figure_.shades == nullptr) return;
        const Shades& shades = *figure_.shades;
        const std::vector<ShadeBand> bands = paper_bands(shades);
        const std::vector<double> x = edges_between(shades.x, panel_.view.x.logarithmic());
        const std::vector<double> y = edges_between(shades.y, panel_.view.y.logarithmic());
        constexpr double seam = 0.4;  // pixels
        const auto place = [](const Scale& scale, double value, double more) {
            return scale.at(std::clamp(scale(value) + more, 0.0, 1.0));
        };
        std::vector<std::vector<std::vector<double>>> columns(bands.size(), std::vector<std::vector<double>>(6));
        for (const ShadeBox& box : boxes_of(shades, bands)) {
            const double left = place(panel_.view.x, x[box.left], 0), bottom = place(panel_.view.y, y[box.bottom], 0);
            const double right = place(panel_.view.x, x[box.right], seam / (panel_.right - panel_.left));
            const double top = place(panel_.view.y, y[box.top], seam / (panel_.top - panel_.bottom));
            if (!(left < right && bottom < top)) continue;
            std::size_t column = 0;
            for (const double value : {left, bottom, left, right, bottom, top})
                columns[box.band][column++].push_back(value);
        }
        for (std::size_t band = 0; band < bands.size(); ++band) {
            if (columns[band].front().empty()) continue;
            elements_.push_back(data_.add(columns[band]) + fmt::format(" with boxxyerror fc rgb '{}' fs solid noborder",
                                                                       shade_colour(band, bands.size())));
        }
    }

    void add_curves() {
        for (const std::size_t i : drawing_order(figure_)) {
            const std::vector<std::string> more = curve_elements(panel_, i, kept_[i], data_);
            elements_.insert(elements_.end(), more.begin(), more.end());
        }
        for (const MarkKind kind : kinds_of(figure_.marks)) {
            std::vector<double> x, y;
            for (const Mark& mark : figure_.marks) {
                if (mark.kind == kind) {
                    x.push_back(mark.x);
                    y.push_back(mark.y);
                }
            }
            elements_.push_back(data_.add({x, y}) + " with points " + mark_style(kind));
        }
    }

    const Sheet& sheet_;
    const PaperPanel& panel_;
    const Figure& figure_;
    const Selection& kept_;
    GnuplotData& data_;
    std::string text_;
    std::vector<std::string> elements_;  // of the plot command
};

// ---- how many points are drawn

constexpr double fineness = 2;          // to the pixel of 1/96 inch: a line is wider than two of them
constexpr double most_bytes = 140'000;  // of the curves in an SVG: all of it shall be smaller than 200 kB

constexpr double point_bytes = 15;  // "L293.68,135.55 "
constexpr double stroke_bytes = 2 * point_bytes;
constexpr double mark_bytes = 110;

double bytes_of(const Curve& curve, const Trace& trace) {
    const double each = curve.style == Style::points ? mark_bytes
                        : curve.style == Style::fill ? 2 * point_bytes  // there and back
                                                     : point_bytes;
    std::size_t strokes = 0;
    for (const Strokes& layer : trace.layers) strokes += layer.all.size();
    return static_cast<double>(strokes) * stroke_bytes + static_cast<double>(trace.places.size()) * each;
}

/// An area has the corners of both its edges, and is interrupted where one of them is.
std::vector<std::size_t> between_edges(const Curve& curve, const Paper& paper) {
    Curve other = curve;
    other.y = *curve.base;
    std::vector<std::size_t> all = thinned(curve, paper);
    const std::vector<std::size_t> more = thinned(other, paper);
    all.insert(all.end(), more.begin(), more.end());
    std::sort(all.begin(), all.end());
    std::vector<std::size_t> kept;
    std::size_t next = 0;
    for (const std::size_t i : all) {
        for (; next <= i && next < curve.size(); ++next) {
            const bool there = paper.view.x.has(curve.x.values[next]) && paper.view.y.has(curve.y.values[next]) &&
                               paper.view.y.has(other.y.values[next]);
            if (!there && !kept.empty() && kept.back() != gap) {
                kept.push_back(gap);
            } else if (there && next == i) {
                kept.push_back(i);
            }
        }
    }
    return kept;
}

void to_sheet(Strokes& strokes) {
    strokes.height /= fineness;
    for (Stroke& stroke : strokes.all) {
        stroke = {stroke.from / fineness, stroke.to / fineness, stroke.y / fineness};
    }
}

/// No larger than `most` bytes, if there is a way to make it so with this coarseness.
Trace trace_of(const Curve& curve, const Paper& paper, double most) {
    Trace trace{curve.style == Style::fill && curve.base ? between_edges(curve, paper) : thinned(curve, paper)};
    if (bytes_of(curve, trace) > most && curve.style != Style::fill && !has_columns(curve)) {
        const auto strokes = static_cast<std::size_t>(most / stroke_bytes);
        trace.places.clear();
        trace.layers = inked(curve, paper, strokes);
        for (Strokes& layer : trace.layers) to_sheet(layer);
    }
    return trace;
}

/// What gets too large is made coarser.
std::vector<Selection> select(const Sheet& sheet) {
    std::size_t curves = 0;
    for (const PaperPanel& panel : sheet.panels) {
        curves += panel.figure->curves.size();
    }
    double most_each = most_bytes;
    double coarseness = 1;
    for (int attempt = 0;; ++attempt) {
        std::vector<Selection> all;
        double bytes = 0;
        for (const PaperPanel& panel : sheet.panels) {
            const Box pixels{(panel.right - panel.left) * fineness, (panel.top - panel.bottom) * fineness};
            const Paper paper{panel.view, pixels, coarseness};
            all.emplace_back();
            for (const Curve& curve : panel.figure->curves) {
                all.back().push_back(trace_of(curve, paper, most_each));
                bytes += bytes_of(curve, all.back().back());
            }
        }
        if (bytes <= most_bytes || attempt == 8) {
            return all;
        }
        if (attempt > 0) {
            coarseness *= 1.5;
        }
        most_each = most_bytes / static_cast<double>(curves);
    }
}

std::string terminal_line(Terminal terminal, const Sheet& sheet) {
    constexpr double most_dots = 4e7;  // of a PNG in all: 160 MB in gnuplot
    const double dots_per_pixel =
        std::min(3.0, std::sqrt(most_dots / (sheet.width * sheet.height)));  // 288 to the inch
    const double cm_wide = sheet.width / pixels_per_cm;
    const double cm_high = sheet.height / pixels_per_cm;
    switch (terminal) {
        case Terminal::svg:
            return fmt::format(
                "set terminal svg size {:.0f},{:.0f} fixed noenhanced font 'Arial,{:.2f}' linewidth 1 "
                "dashlength 0.5 background rgb '#FFFFFF'\n",
                sheet.width, sheet.height, em);
        case Terminal::png:
            return fmt::format(
                "set terminal pngcairo size {:.0f},{:.0f} noenhanced font 'Sans,{}' fontscale {} "
                "linewidth {} dashlength 1 pointscale {}\n",
                sheet.width * dots_per_pixel, sheet.height * dots_per_pixel, font_size, dots_per_pixel, dots_per_pixel,
                1.3 * dots_per_pixel);
        case Terminal::pdf:
            return fmt::format(
                "set terminal pdfcairo size {:.3f}cm,{:.3f}cm noenhanced font 'Sans,{}' fontscale 0.75 "
                "linewidth 1.5 dashlength 1 pointscale 0.95\n",
                cm_wide, cm_high, font_size);
    }
    return "";
}

std::string commands(const Sheet& sheet, GnuplotData& data) {
    const std::vector<Selection> kept = select(sheet);
    const bool several = sheet.panels.size() > 1;
    std::string text = several ? "set multiplot\n" : "";
    for (std::size_t i = 0; i < sheet.panels.size(); ++i) {
        text += PanelScript(sheet, sheet.panels[i], kept[i], data).text();
        text += data.take_binary();
    }
    return text + (several ? "unset multiplot\n" : "");
}

/// The figures as they are drawn on a sheet of that size.
std::vector<Figure> on_paper(std::span<const Figure> figures, PaperSize size) {
    constexpr double usual = 8.5;  // cm
    constexpr double box = 0.85;   // of the width, to the curves
    return with_bands(figures, box * pixels_per_cm * (size.width > 0 ? size.width : usual));
}

}  // namespace

std::string gnuplot_input(std::span<const Figure> given, Terminal terminal, PaperSize size) {
    const std::vector<Figure> figures = on_paper(given, size);
    const Sheet sheet = lay_out(figures, size);
    GnuplotData data(DataForm::binary);
    return "set encoding utf8\n" + terminal_line(terminal, sheet) + commands(sheet, data);
}

std::string gnuplot_file(std::span<const Figure> given, PaperSize size) {
    const std::vector<Figure> figures = on_paper(given, size);
    const Sheet sheet = lay_out(figures, size);
    GnuplotData data(DataForm::text);
    const std::string text = commands(sheet, data);
    return "# A figure of dinal, to be restyled. Draw it with: gnuplot THIS_FILE > figure.svg\n"
           "set encoding utf8\n" +
           terminal_line(Terminal::svg, sheet) + "# " + terminal_line(Terminal::png, sheet) + "# " +
           terminal_line(Terminal::pdf, sheet) + data.blocks() + text;
}

std::string GnuplotData::add(const std::vector<std::vector<double>>& columns) {
    std::string use;
    std::string format;
    for (std::size_t column = 0; column < columns.size(); ++column) {
        use += fmt::format("{}{}", column == 0 ? "" : ":", column + 1);
        format += "%double";
    }
    const std::size_t rows = columns.front().size();
    if (form_ == DataForm::binary) {
        for (std::size_t row = 0; row < rows; ++row) {
            for (const std::vector<double>& column : columns) {
                binary_.append(reinterpret_cast<const char*>(&column[row]), sizeof(double));  // as it lies in memory
            }
        }
        return fmt::format("'-' binary record=({}) format='{}' using {}", rows, format, use);
    }
    const std::string name = fmt::format("$data{}", ++count_);
    blocks_ += name + " << end\n";
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t column = 0; column < columns.size(); ++column) {
            const double value = columns[column][row];
            blocks_ +=
                fmt::format("{}{}", column == 0 ? "" : " ", std::isnan(value) ? "NaN" : fmt::format("{}", value));
        }
        blocks_ += '\n';
    }
    blocks_ += "end\n";
    return fmt::format("{} using {}", name, use);
}

std::string GnuplotData::take_binary() {
    return std::exchange(binary_, {});
}

std::string quoted_words(std::string_view text) {
    std::string result = "'";
    for (const char c : text::displayable(text)) {
        // NOTE: gnuplot 5.4 loses count of apostrophes that follow each other, also of doubled ones. Between double
        // quotes nothing but an apostrophe is ever put, for in them a backquote starts a shell.
        result += c == '\'' ? std::string("'.\"'\".'") : std::string{c};
    }
    return result + "'";
}

}  // namespace dinal::plots
