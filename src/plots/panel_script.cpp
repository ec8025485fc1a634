#include "plots/panel_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "plots/bands.hpp"
#include "plots/paper_style.hpp"
#include "plots/shades.hpp"

namespace dinal::plots {
namespace {

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
                case Sample::shade:
                    line(fmt::format("set object rectangle from {} to {} fc rgb '{}' fs solid noborder",
                                     at(entry.x, entry.y - 0.35 * em), at(entry.x + width, entry.y + 0.35 * em),
                                     shade_colour(entry.curve, paper_bands(*figure_.shades).size())));
                    break;
                case Sample::curve:
                    add_sample_of_curve(entry);
                    break;
                case Sample::none:
                    break;
            }
        }
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

}  // namespace

std::string panel_script(const Sheet& sheet, const PaperPanel& panel, const Selection& kept, GnuplotData& data) {
    return PanelScript(sheet, panel, kept, data).text();
}

}  // namespace dinal::plots
