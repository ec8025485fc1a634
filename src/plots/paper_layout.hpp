// Where the parts of a printed figure stand: the box of the curves, and around it ticks, labels, legend and title.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "plots/figure.hpp"
#include "plots/ticks.hpp"

namespace dinal::plots {

inline constexpr double font_size = 8;             // points
inline constexpr double em = font_size * 96 / 72;  // pixels of 1/96 inch, the unit of this file
inline constexpr double pixels_per_cm = 96 / 2.54;

/// Centimetres. Zero: as wide as a column of a paper (two panels: as its text), and as high as that needs.
struct PaperSize {
    double width = 0;
    double height = 0;
};

enum class Sample { curve, mark, dead_zone, stuck, nothing, no_value, none };

/// A line of the legend: a sample, and words to its right.
struct LegendEntry {
    Sample sample;
    std::size_t curve;  // which, for a curve
    std::string text;
    double x = 0, y = 0;  // of the left end of the sample, in the middle of the line
};
constexpr double sample_width(Sample sample) {
    return (sample == Sample::none ? 0 : sample == Sample::mark ? 0.8 : 2.2) * em;
}
inline constexpr double after_sample = 0.4 * em;

/// What the colours of a map mean: cells one above the other beside its box, of one height, the least below.
struct ColourBar {
    double left = 0, right = 0;
    std::size_t cells = 0;
    bool continuous = false;                                  ///< the colours flow into each other
    std::vector<std::pair<double, std::string>> labels = {};  ///< places in cells from the bottom
};

/// Where a line ends that has its name there, in fractions of the box; at the right edge names stand outside.
struct NamedEnd {
    std::size_t curve;
    double right, up;
    [[nodiscard]] bool outside() const { return right > 0.9; }
};
std::vector<NamedEnd> named_ends(const Figure& figure, const View& view);
inline constexpr double to_end_name = 0.9 * em;  // from the box

/// Words somewhere on the sheet.
struct Words {
    std::string text;
    double x = 0, y = 0;  // their middle
};

/// All places in pixels from the upper left corner of the sheet.
struct PaperPanel {
    const Figure* figure;
    View view;
    Ticks x_ticks = {}, y_ticks = {};
    double left = 0, bottom = 0, right = 0, top = 0;  // the box of the curves
    double unused = 0;                                // of the height, because the box may not be higher than that
    double above = 0, below = 0;                      // room for title and legend, and for what stands under the box
    ColourBar bar = {};
    std::vector<LegendEntry> legend = {};
    Words title = {}, x_label = {}, y_label = {}, bar_label = {};
};

struct Sheet {
    double width, height;
    std::vector<PaperPanel> panels;
};

Sheet lay_out(std::span<const Figure> figures, PaperSize size);

/// As a printer sets it: "−0.5", "2·10⁻⁹".
std::string typeset(const std::string& number);

}  // namespace dinal::plots
