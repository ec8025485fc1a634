// A figure as a value: curves, marks and spans over two axes, before anybody decides how to draw it.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "text/option.hpp"

namespace dinal::plots {

/// Numbers to draw: a view and what keeps it alive. Shared, because a picture may outlive the run it shows.
struct Numbers {
    std::shared_ptr<const void> owner;
    std::span<const double> values;

    static Numbers own(std::vector<double> numbers) {
        const auto kept = std::make_shared<const std::vector<double>>(std::move(numbers));
        return {kept, *kept};
    }
};

struct Interval {
    double low = 0;
    double high = 1;
    [[nodiscard]] double length() const { return high - low; }
};

enum class Style { line, points, fill };
/// How a line is broken; `by_place` is another one for each curve, so that a grey print still tells them apart.
enum class Dashes { by_place, solid, dashed, dotted, dash_dotted };

/// The shorter of x and y counts. What is not finite, or cannot stand on a logarithmic axis, is a gap.
struct Curve {
    Numbers x, y;
    std::string label = {};  ///< none: not in the legend
    Style style = Style::line;
    Dashes dashes = Dashes::by_place;
    int colour = 0;                    ///< 1, 2, ... of the palette; 0: by place
    std::optional<Numbers> base = {};  ///< a fill reaches from y to this, to zero without it
    bool behind = false;               ///< drawn before the others; where it is dense, as the band it fills
    [[nodiscard]] std::size_t size() const { return std::min(x.values.size(), y.values.size()); }
};

inline constexpr const char* style_names[] = {"line", "points", "fill"};
inline constexpr const char* dashes_names[] = {"automatic", "solid", "dashed", "dotted", "dash-dotted"};
inline constexpr text::Option curve_options[] = {
    {.name = "label", .meaning = "its name in the picture", .filled = text::fills<&Curve::label>},
    {.name = "style",
     .meaning = "style of drawing; a fill extends to zero, or to base",
     .filled = text::fills<&Curve::style>,
     .choices = style_names},
    {.name = "dashes",
     .meaning = "dash pattern of its line; by default a different one for each curve",
     .filled = text::fills<&Curve::dashes>,
     .choices = dashes_names},
    {.name = "colour",
     .range = {"be a whole number from 1 to 7", [](double x) { return text::is_whole(x, 1, 7); }},
     .meaning = "its colour; by default a different one for each curve",
     .filled = text::fills<&Curve::colour>},
    {.name = "base", .meaning = "the second edge of a fill: a vector as long as x"},
};

struct Axis {
    std::string label = {};
    std::optional<Interval> limits = {};
    std::vector<double> ticks = {};       ///< where they stand; none: at round numbers
    std::optional<double> division = {};  ///< or at the multiples of this (DIVX, DIVY of DRAAR)
    bool logarithmic = false;
    bool names_curves = false;  ///< the label is a unit alone: on paper the names of the curves stand before it
};

enum class MarkKind { start, end, impact, switched };
inline constexpr const char* mark_names[] = {"start", "end", "impact", "switch"};
struct Mark {
    double x = 0;
    double y = 0;
    MarkKind kind = MarkKind::start;
};

struct Shades;  // shades.hpp

/// The kinds among the marks, each once.
std::vector<MarkKind> kinds_of(const std::vector<Mark>& marks);

struct Figure {
    std::string title = {};
    bool below = false;  ///< stands under the figure before it, with the same x
    Axis x, y;
    bool equal = false;    ///< one unit is as long on both axes
    bool axes = true;      ///< frame, ticks, labels and grid
    bool ends = false;     ///< on paper the names of lines stand where these end, not in the legend
    bool circles = false;  ///< about the origin, through the ticks: lines of equal energy in a phase plane
    std::shared_ptr<const Shades> shades = {};  ///< a map, behind all the rest
    std::vector<Curve> curves;
    std::vector<Mark> marks;
    std::vector<Interval> stuck;             ///< intervals of x, marked at its axis
    std::optional<Interval> dead_zone = {};  ///< of x, marked on y = 0
};

/// Numbers beyond 1e300 would overflow in differences, and nobody could see them.
inline bool drawable(double value, bool logarithmic) {
    return std::fabs(value) <= 1e300 && (!logarithmic || value > 0);
}

/// Fractions of a shorter one could not be told.
inline constexpr double shortest_axis = 1e-305;

/// One axis as it is drawn: from a value to its fraction of the axis.
class Scale {
public:
    Scale(Interval range, bool logarithmic);
    [[nodiscard]] Interval range() const { return range_; }
    [[nodiscard]] bool logarithmic() const { return logarithmic_; }
    /// 0 at the low end, 1 at the high one; NaN for what has no place.
    [[nodiscard]] double operator()(double value) const {
        return ((logarithmic_ ? std::log10(value) : value) - low_) * factor_;
    }
    [[nodiscard]] bool has(double value) const { return drawable(value, logarithmic_); }
    /// The value at that fraction of the axis.
    [[nodiscard]] double at(double fraction) const {
        const double place = low_ + fraction / factor_;
        return logarithmic_ ? std::pow(10, place) : place;
    }

private:
    Interval range_;
    bool logarithmic_;
    double low_;
    double factor_;
};

struct View {
    Scale x, y;
};

/// What is seen of a figure: the limits asked for, else all data with some air around them.
View view_of(const Figure& figure);

/// The largest box of at most width times height in which one unit is as long on both axes (in a text or a paper of
/// square dots). Where that box would be a thread the view is widened.
struct Box {
    double width, height;
};
Box equal_box(View& view, Box most);

// Points and straight lines on a sheet, in dots or pixels.

struct Point {
    double x, y;
};

struct Line {
    Point from, to;
};

/// Cuts the line to the sheet, which reaches from -slack to its size and slack (Liang and Barsky); false when nothing
/// is left.
bool clip(Line& line, Box sheet, double slack);

// What swings too densely to be seen behind another curve, as the band that it fills.

/// The figures with bands in place of the curves behind others (Curve::behind) that turn back more often than the eye
/// can follow on `width`: in places that it parts, such as dots of a text or pixels of a sheet.
std::vector<Figure> with_bands(std::span<const Figure> figures, double width);

/// The figures with envelopes in place of all curves that turn nearly every second of these places: drawn as they are,
/// they would be noise.
std::vector<Figure> with_envelopes(std::span<const Figure> figures, double width);

/// The places of the curves, those behind others first.
std::vector<std::size_t> drawing_order(const Figure& figure);

}  // namespace dinal::plots
