#include "io/gnuplot_script.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/gnuplot_data.hpp"
#include "io/panel_script.hpp"
#include "io/paper_layout.hpp"
#include "io/thinning.hpp"

namespace dinal {
namespace {

constexpr std::size_t most_points = 11'000;  // of all curves together: an SVG below 200 kB

Selection select(const Panel& panel, double coarseness) {
    constexpr double fineness = 2;  // to the pixel of 1/96 inch: a line is wider than two of them
    const Paper paper{
        panel.view, {(panel.right - panel.left) * fineness, (panel.top - panel.bottom) * fineness}, coarseness};
    Selection selection;
    for (const Curve& curve : panel.figure->curves) {
        selection.push_back(thinned(curve, paper));
        if (curve.style == Style::fill && curve.base) {  // the other edge has extremes of its own
            Curve edge{curve.x, *curve.base};
            std::vector<std::size_t> more = thinned(edge, paper);
            more.insert(more.end(), selection.back().begin(), selection.back().end());
            std::sort(more.begin(), more.end());
            more.erase(std::unique(more.begin(), more.end()), more.end());
            selection.back() = std::move(more);
        }
    }
    return selection;
}

/// What gets too large is made coarser.
std::vector<Selection> select(const Sheet& sheet) {
    std::vector<Selection> all;
    double coarseness = 1;
    for (int attempt = 0; attempt < 8; ++attempt) {
        all.clear();
        std::size_t points = 0;
        for (const Panel& panel : sheet.panels) {
            all.push_back(select(panel, coarseness));
            for (const auto& kept : all.back()) {
                points += kept.size();
            }
        }
        if (points <= most_points) {
            break;
        }
        coarseness *= 1.5;
    }
    return all;
}

std::string terminal_line(Terminal terminal, const Sheet& sheet) {
    constexpr double dots_per_pixel = 3;  // of a PNG: 288 to the inch
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
                dots_per_pixel);
        case Terminal::pdf:
            return fmt::format(
                "set terminal pdfcairo size {:.3f}cm,{:.3f}cm noenhanced font 'Sans,{}' fontscale 0.75 "
                "linewidth 1.7 dashlength 1\n",
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

}  // namespace

std::string gnuplot_input(std::span<const Figure> figures, Terminal terminal, PaperSize size) {
    const Sheet sheet = lay_out(figures, size);
    GnuplotData data(DataForm::binary);
    return "set encoding utf8\n" + terminal_line(terminal, sheet) + commands(sheet, data);
}

std::string gnuplot_file(std::span<const Figure> figures, PaperSize size) {
    const Sheet sheet = lay_out(figures, size);
    GnuplotData data(DataForm::text);
    const std::string text = commands(sheet, data);
    return "# A figure of dinal, to be restyled. Draw it with: gnuplot THIS_FILE > figure.svg\n"
           "set encoding utf8\n" +
           terminal_line(Terminal::svg, sheet) + "# " + terminal_line(Terminal::png, sheet) + "# " +
           terminal_line(Terminal::pdf, sheet) + data.blocks() + text;
}

}  // namespace dinal
