#include "io/panel_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
namespace dinal {
namespace {

// Okabe and Ito's colours, which the colour-blind tell apart, without the yellow, which paper swallows.
constexpr std::array<std::string_view, 7> palette{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#000000", "#E69F00", "#56B4E9"};
// Another length of this list than of that one: the pair repeats after 42 curves only.
constexpr std::array<std::string_view, 6> dash_types{"1", "(11,4)", "(2,3)", "(11,3,2,3)", "(6,3)", "(11,3,2,3,2,3)"};
constexpr std::string_view ink = "#444444";
constexpr double fill_density = 0.25;

struct Look {
    std::string colour, dashes;
};

Look look_of(const Figure& figure, std::size_t curve) {
    const Curve& own = figure.curves[curve];
    const std::size_t colour = own.colour > 0 ? static_cast<std::size_t>(own.colour - 1) : curve;
    std::size_t dashes = curve % dash_types.size();
    if (own.dashes != Dashes::by_place) {
        dashes = own.dashes == Dashes::solid ? 0 : own.dashes == Dashes::dashed ? 1 : 2;
    }
    return {std::string(palette[colour % palette.size()]), std::string(dash_types[dashes])};
}

class PanelScript {
public:
    PanelScript(const Sheet& sheet, const Panel& panel, const Selection& kept, GnuplotData& data)
        : sheet_(sheet), panel_(panel), figure_(*panel.figure), kept_(kept), data_(data) {}

    std::string text() {
        add_box();
        add_axis('x', figure_.x, panel_.view.x, panel_.x_ticks);
        add_axis('y', figure_.y, panel_.view.y, panel_.y_ticks);
        add_legend();
        add_stuck();
        add_circles();
        for (std::size_t i = 0; i < figure_.curves.size(); ++i) {
            add_curve(i);
        }
        add_marks();
        if (elements_.empty()) {
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
            line(fmt::format("set border 3 lt 1 lw 0.8 lc rgb '{}'", ink));
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
            line(fmt::format("set label {} at {} center{} textcolor rgb '{}'", single_quoted(words.text),
                             at(words.x, words.y), how, ink));
        }
    }

    void add_axis(char name, const Axis& axis, const Scale& scale, const Ticks& ticks) {
        line(fmt::format("set {}range [{}:{}]", name, scale.range().low, scale.range().high));
        if (axis.logarithmic) {
            line(fmt::format("set logscale {}", name));
        }
        if (!figure_.axes) {
            line(fmt::format("unset {}tics", name));
            return;
        }
        std::vector<std::string> list;
        for (std::size_t i = 0; i < ticks.at.size(); ++i) {
            list.push_back(fmt::format("'{}' {}", typeset(ticks.text[i]), ticks.at[i]));
        }
        line(fmt::format("set {}tics nomirror out scale 0.5 offset {} textcolor rgb '{}' ({})", name,
                         name == 'x' ? "0,0.3" : "0.5,0", ink, fmt::join(list, ", ")));
    }

    void add_legend() {
        for (const LegendEntry& entry : panel_.legend) {
            const double width = sample_width(entry.sample);
            line(fmt::format("set label {} at {} left textcolor rgb '{}'", single_quoted(entry.text),
                             at(entry.x + width + after_sample, entry.y), ink));
            const Curve* curve = entry.sample == Sample::curve ? &figure_.curves[entry.curve] : nullptr;
            const Look look = curve != nullptr ? look_of(figure_, entry.curve) : Look{std::string(ink), "1"};
            if (entry.sample == Sample::start || entry.sample == Sample::end) {
                add_sample_point(entry, mark_style(entry.sample == Sample::start));
            } else if (curve != nullptr && curve->style == Style::points) {
                add_sample_point(entry, point_style(entry.curve));
            } else if (curve != nullptr && curve->style == Style::fill) {
                line(fmt::format("set object rectangle from {} to {} fc rgb '{}' fs transparent solid {} noborder",
                                 at(entry.x, entry.y - 0.35 * em), at(entry.x + width, entry.y + 0.35 * em),
                                 look.colour, fill_density));
            } else {
                line(fmt::format("set arrow from {} to {} nohead {}", at(entry.x, entry.y),
                                 at(entry.x + width, entry.y),
                                 curve != nullptr                    ? line_style(entry.curve)
                                 : entry.sample == Sample::dead_zone ? dead_zone_style()
                                                                     : bar_style()));
            }
        }
    }

    void add_sample_point(const LegendEntry& entry, const std::string& style) {
        line(fmt::format("set label '' at {} point {}", at(entry.x + sample_width(entry.sample) / 2, entry.y), style));
    }

    [[nodiscard]] std::string line_style(std::size_t curve) const {
        const Look look = look_of(figure_, curve);
        return fmt::format("lt 1 lw {} dt {} lc rgb '{}'", line_width, look.dashes, look.colour);
    }
    [[nodiscard]] std::string point_style(std::size_t curve) const {
        constexpr std::array<int, 5> shapes{6, 2, 8, 4, 1};  // circle, x, triangle, square, +
        return fmt::format("pt {} ps 0.45 lw 0.9 lc rgb '{}'", shapes[curve % shapes.size()],
                           look_of(figure_, curve).colour);
    }
    static std::string mark_style(bool start) {
        return fmt::format("pt {} ps 0.7 lw 1.2 lc rgb '{}'", start ? 6 : 7, ink);
    }
    static std::string dead_zone_style() { return "lt 1 dt 1 lw 4 lc rgb '#909090'"; }
    static std::string bar_style() { return fmt::format("lt 1 dt 1 lw 4 lc rgb '{}'", ink); }

    /// Bars just above the time axis; thousands of stops that no eye parts become one.
    void add_stuck() {
        const Range seen = panel_.view.x.range();
        const double finest = seen.length() / (2 * (panel_.right - panel_.left));
        Range bar{seen.high, seen.high};
        const auto draw = [&] {
            if (bar.high > bar.low) {
                line(
                    fmt::format("set object rectangle from first {}, graph 0 to first {}, graph 0.02 front fc rgb "
                                "'{}' fs solid noborder",
                                bar.low, bar.high, ink));
            }
        };
        for (const Range& span : figure_.stuck) {
            const double low = std::max(span.low, seen.low);
            const double high = std::min(std::max(span.high, low + finest), seen.high);
            if (low > high) {
                continue;
            }
            if (low - bar.high <= finest && bar.high > bar.low) {
                bar.high = std::max(bar.high, high);
                continue;
            }
            draw();
            bar = {low, high};
        }
        draw();
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

    void add_curve(std::size_t i) {
        const Curve& curve = figure_.curves[i];
        const Trace& trace = kept_[i];
        if (!trace.ink.all.empty()) {
            constexpr double overlap = 1.6;  // or a screen shows the seams between rows
            elements_.push_back(fmt::format("{} with lines lt 1 dt 1 lw {:.3f} lc rgb '{}'",
                                            data_.add(columns_of(trace.ink.all)), overlap * trace.ink.height,
                                            look_of(figure_, i).colour));
        } else if (curve.style == Style::fill) {
            add_fill(i);
        } else if (curve.style == Style::points) {
            add_points(curve, trace.places, point_style(i));
        } else {
            add_line(i);
        }
    }

    void add_points(const Curve& curve, const std::vector<std::size_t>& places, const std::string& style) {
        if (!places.empty()) {
            elements_.push_back(data_.add(columns_of(curve, places)) + " with points " + style);
        }
    }

    /// What is no longer than a dot would leave no ink.
    void add_line(std::size_t i) {
        const Curve& curve = figure_.curves[i];
        std::vector<std::size_t> dots;
        std::vector<std::size_t> lines;
        for (const std::vector<std::size_t>& piece : pieces_of(kept_[i].places)) {
            if (is_dot(curve, piece)) {
                dots.push_back(piece.front());
            } else {
                lines.insert(lines.end(), piece.begin(), piece.end());
                lines.push_back(gap);
            }
        }
        if (!lines.empty()) {
            lines.pop_back();
            elements_.push_back(data_.add(columns_of(curve, lines)) + " with lines " + line_style(i));
        }
        add_points(curve, dots, fmt::format("pt 7 ps 0.3 lc rgb '{}'", look_of(figure_, i).colour));
    }

    [[nodiscard]] bool is_dot(const Curve& curve, const std::vector<std::size_t>& piece) const {
        const auto near = [&](double a, double b, double pixels) { return std::fabs(a - b) * pixels < line_width; };
        return std::all_of(piece.begin(), piece.end(), [&](std::size_t place) {
            return near(panel_.view.x(curve.x.values[place]), panel_.view.x(curve.x.values[piece.front()]),
                        panel_.right - panel_.left) &&
                   near(panel_.view.y(curve.y.values[place]), panel_.view.y(curve.y.values[piece.front()]),
                        panel_.top - panel_.bottom);
        });
    }

    /// NaN would close an area where it opens: each piece is drawn for itself.
    void add_fill(std::size_t i) {
        const Curve& curve = figure_.curves[i];
        for (const std::vector<std::size_t>& piece : pieces_of(kept_[i].places)) {
            std::vector<std::vector<double>> columns = columns_of(curve, piece);
            const double zero = panel_.view.y.logarithmic() ? panel_.view.y.range().low : 0;
            columns.emplace_back();
            for (const std::size_t place : piece) {
                columns.back().push_back(curve.base ? curve.base->values[place] : zero);
            }
            elements_.push_back(fmt::format("{} with filledcurves fc rgb '{}' fs transparent solid {} noborder",
                                            data_.add(columns), look_of(figure_, i).colour, fill_density));
        }
    }

    static std::vector<std::vector<std::size_t>> pieces_of(const std::vector<std::size_t>& places) {
        std::vector<std::vector<std::size_t>> pieces;
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

    static std::vector<std::vector<double>> columns_of(const Curve& curve, const std::vector<std::size_t>& places) {
        std::vector<std::vector<double>> columns(2);
        for (const std::size_t place : places) {
            columns[0].push_back(place == gap ? std::nan("") : curve.x.values[place]);
            columns[1].push_back(place == gap ? std::nan("") : curve.y.values[place]);
        }
        return columns;
    }

    [[nodiscard]] std::vector<std::vector<double>> columns_of(const std::vector<Stroke>& strokes) const {
        std::vector<std::vector<double>> columns(2);
        const double width = panel_.right - panel_.left;
        for (const Stroke& stroke : strokes) {
            const double y = panel_.view.y.at(stroke.y / (panel_.top - panel_.bottom));
            columns[0].insert(columns[0].end(), {panel_.view.x.at(stroke.from / width),
                                                 panel_.view.x.at(stroke.to / width), std::nan("")});
            columns[1].insert(columns[1].end(), {y, y, std::nan("")});
        }
        return columns;
    }

    void add_marks() {
        if (figure_.dead_zone) {
            elements_.push_back(data_.add({{figure_.dead_zone->low, figure_.dead_zone->high}, {0, 0}}) +
                                " with lines " + dead_zone_style());
        }
        for (const Mark& mark : figure_.marks) {
            elements_.push_back(data_.add({{mark.x}, {mark.y}}) + " with points " +
                                mark_style(mark.kind == MarkKind::start));
        }
    }

    const Sheet& sheet_;
    const Panel& panel_;
    const Figure& figure_;
    const Selection& kept_;
    GnuplotData& data_;
    std::string text_;
    std::vector<std::string> elements_;  // of the plot command
};

}  // namespace

std::string panel_script(const Sheet& sheet, const Panel& panel, const Selection& kept, GnuplotData& data) {
    return PanelScript(sheet, panel, kept, data).text();
}

}  // namespace dinal
