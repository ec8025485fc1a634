// Figures as values, independent of their output: curves, marks and spans over two axes.
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

/// A view of numbers with their owner, as a picture may outlive its run.
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
    double length() const { return high - low; }
};

enum class Style { line, points, fill };
/// The dash pattern; `by_place` gives each curve its own, for greyscale prints.
enum class Dashes { by_place, solid, dashed, dotted, dash_dotted };

/// The shorter of x and y determines the length. Values that are not finite, or not positive on a logarithmic axis, are
/// gaps.
struct Curve {
    Numbers x, y;
    std::string label = {};  ///< empty: not in the legend
    Style style = Style::line;
    Dashes dashes = Dashes::by_place;
    int colour = 0;                    ///< 1, 2, ... in the palette; 0: by position
    std::optional<Numbers> base = {};  ///< fills extend from y to this, by default to zero
    bool behind = false;               ///< whether it is drawn first; a dense curve becomes a band
    std::size_t size() const { return std::min(x.values.size(), y.values.size()); }
};

inline constexpr const char* style_names[] = {"line", "points", "fill"};
inline constexpr const char* dashes_names[] = {"automatic", "solid", "dashed", "dotted", "dash-dotted"};
inline constexpr text::Option curve_options[] = {
    text::option<&Curve::label>("label", "its name in the picture"),
    text::option<&Curve::style>("style", "style of drawing; a fill extends to zero, or to base",
                                {.choices = style_names}),
    text::option<&Curve::dashes>("dashes", "dash pattern of its line; by default a different one for each curve",
                                 {.choices = dashes_names}),
    text::option<&Curve::colour>(
        "colour", "its colour, a whole number from 1 to 7; by default a different one for each curve",
        {.range = {"be a whole number from 1 to 7", [](double x) { return text::is_whole(x, 1, 7); }}}),
    {.name = "base", .meaning = "the second edge of a fill: a vector as long as x"},
};

struct Axis {
    std::string label = {};
    std::optional<Interval> limits = {};
    std::vector<double> ticks = {};       ///< positions of the ticks; empty: round numbers
    std::optional<double> division = {};  ///< distance of ticks at its multiples (DIVX, DIVY of DRAAR)
    bool logarithmic = false;
    bool names_curves = false;  ///< whether the label is a unit only, preceded by the curves' names on paper
};

enum class MarkKind { start, end, impact, switched };
inline constexpr const char* mark_names[] = {"start", "end", "impact", "switch"};
struct Mark {
    double x = 0;
    double y = 0;
    MarkKind kind = MarkKind::start;
};

struct Shades;  // see shades.hpp

/// The distinct kinds of these marks.
std::vector<MarkKind> kinds_of(const std::vector<Mark>& marks);

struct Figure {
    std::string title = {};
    bool below = false;  ///< whether it stands below the previous figure with a common x axis
    Axis x, y;
    bool equal = false;                         ///< whether units are equally long on both axes
    bool axes = true;                           ///< whether to draw frame, ticks, labels and grid
    bool ends = false;                          ///< whether paper shows names at the ends of lines instead of a legend
    bool circles = false;                       ///< whether to draw circles of equal energy in a phase plane
    std::shared_ptr<const Shades> shades = {};  ///< a map behind everything else
    std::vector<Curve> curves;
    std::vector<Mark> marks;
    std::vector<Interval> stuck;             ///< intervals of x, marked at its axis
    std::optional<Interval> dead_zone = {};  ///< interval of x, marked on y = 0
};

/// Returns whether the value can be drawn; larger numbers would overflow in differences.
inline bool drawable(double value, bool logarithmic) {
    return std::fabs(value) <= 1e300 && (!logarithmic || value > 0);
}

/// Fractions of a shorter axis cannot be computed.
inline constexpr double shortest_axis = 1e-305;

/// Maps a value to its fraction of an axis.
class Scale {
public:
    Scale(Interval range, bool logarithmic);
    Interval range() const { return range_; }
    bool logarithmic() const { return logarithmic_; }
    /// 0 at the low end, 1 at the high end; NaN outside of the domain.
    [[nodiscard]] double operator()(double value) const {
        return ((logarithmic_ ? std::log10(value) : value) - low_) * factor_;
    }
    bool has(double value) const { return drawable(value, logarithmic_); }
    /// The value at that fraction of the axis.
    double at(double fraction) const {
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

/// The visible ranges: given limits, otherwise all data with a margin.
View view_of(const Figure& figure);

/// The largest box within width times height with equal units on both axes (square dots). Widens the view if the box
/// would be too narrow.
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

/// Clips the line to the sheet enlarged by `slack` (Liang and Barsky); returns false if nothing remains.
bool clip(Line& line, Box sheet, double slack);

// Dense oscillations behind other curves are drawn as bands.

/// Replaces curves marked `behind` by bands if their extremes are too close to be seen. `width` is in units of
/// resolution, such as dots or pixels.
std::vector<Figure> with_bands(std::span<const Figure> figures, double width);

/// Replaces curves with an extreme in nearly every second unit of `width` by envelopes, because they would look like
/// noise.
std::vector<Figure> with_envelopes(std::span<const Figure> figures, double width);

/// The indices of the extremes of a curve and of both ends; movements up to `smallest` do not count.
std::vector<std::size_t> turns_of(std::span<const double> y, double smallest);

/// The indices of the curves, background curves first.
std::vector<std::size_t> drawing_order(const Figure& figure);

}  // namespace dinal::plots
