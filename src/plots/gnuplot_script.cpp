#include "plots/gnuplot_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plots/bands.hpp"
#include "plots/gnuplot_data.hpp"
#include "plots/panel_script.hpp"
#include "plots/paper_layout.hpp"
#include "plots/paper_style.hpp"

namespace dinal::plots {
namespace {

constexpr double fineness = 2;          // to the pixel of 1/96 inch: a line is wider than two of them
constexpr double most_bytes = 140'000;  // of the curves in an SVG: all of it shall be smaller than 200 kB

constexpr double point_bytes = 15;  // "L293.68,135.55 "
constexpr double stroke_bytes = 2 * point_bytes;
constexpr double mark_bytes = 110;

constexpr std::size_t crowd_of_points = 10'000;  // whose ink alone would be solid blocks

double bytes_of(const Curve& curve, const Trace& trace) {
    const double each = curve.style == Style::points ? mark_bytes
                        : curve.style == Style::fill ? 2 * point_bytes  // there and back
                                                     : point_bytes;
    std::size_t strokes = trace.ink.all.size();
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
        if (curve.style == Style::points && curve.size() > crowd_of_points) {
            trace.layers = crowded(curve, paper, strokes);
        } else {
            trace.ink = inked(curve, paper, line_width * fineness, strokes);
        }
        to_sheet(trace.ink);
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
        text += panel_script(sheet, sheet.panels[i], kept[i], data);
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

}  // namespace dinal::plots
