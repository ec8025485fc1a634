// Figures on paper: their layout, and their files, SVG, PDF and PNG, drawn with cairo.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "plots/figure.hpp"
#include "plots/ticks.hpp"
#include "text/expected.hpp"

namespace dinal::plots {

inline constexpr double font_size = 8;             // points
inline constexpr double em = font_size * 96 / 72;  // pixels of 1/96 inch, the unit of this file
inline constexpr double pixels_per_cm = 96 / 2.54;

/// In centimetres. A width of 0 means the width of a column of a paper (for two panels, of its text), a height of 0 the
/// required height.
struct PaperSize {
    double width = 0;
    double height = 0;
};

enum class Sample { curve, mark, dead_zone, stuck, nothing, no_value, none };

/// A line of the legend: a sample with words to its right.
struct LegendEntry {
    Sample sample;
    std::size_t curve;  // index of the curve
    std::string text;
    double x = 0, y = 0;  // left end of the sample, middle of the line
};
constexpr double sample_width(Sample sample) {
    return (sample == Sample::none ? 0 : sample == Sample::mark ? 0.8 : 2.2) * em;
}
inline constexpr double after_sample = 0.4 * em;

/// The colour bar of a map: cells of equal height beside its box, lowest values at the bottom.
struct ColourBar {
    double left = 0, right = 0;
    std::size_t cells = 0;
    bool continuous = false;                                  ///< whether the colours are continuous
    std::vector<std::pair<double, std::string>> labels = {};  ///< positions in cells from the bottom
};

/// The labelled end of a line, in fractions of the box; at the right edge the name is outside.
struct NamedEnd {
    std::size_t curve;
    double right, up;
    bool outside() const { return right > 0.9; }
};
std::vector<NamedEnd> named_ends(const Figure& figure, const View& view);
inline constexpr double to_end_name = 0.9 * em;  // distance from the box

/// Words at a place on the sheet.
struct Words {
    std::string text;
    double x = 0, y = 0;  // their centre
};

/// All positions in pixels from the upper left corner of the sheet.
struct PaperPanel {
    const Figure* figure;
    View view;
    Ticks x_ticks = {}, y_ticks = {};
    double left = 0, bottom = 0, right = 0, top = 0;  // box of the curves
    double unused = 0;                                // height that the box does not need
    double above = 0, below = 0;                      // room for title and legend, and below the box
    ColourBar bar = {};
    std::vector<LegendEntry> legend = {};
    Words title = {}, x_label = {}, y_label = {}, bar_label = {};
};

struct Sheet {
    double width, height;
    std::vector<PaperPanel> panels;
};

Sheet lay_out(std::span<const Figure> figures, PaperSize size);

/// A number in typographic form: "−0.5", "2·10⁻⁹".
std::string typeset(const std::string& number);

enum class PictureKind { svg, png, pdf };

/// The bytes of the file. An SVG has a title and a description for screen readers. go_on() is called every few thousand
/// points; false ends drawing with an error.
text::Expected<std::string> paint(
    std::span<const Figure> given, PictureKind kind, PaperSize size,
    const std::function<bool()>& go_on = [] { return true; });

}  // namespace dinal::plots
