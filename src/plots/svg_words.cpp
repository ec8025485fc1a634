#include "plots/svg_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plots/shades.hpp"
#include "text/characters.hpp"
#include "text/html.hpp"

namespace dinal::plots {
namespace {

/// "θ, rad" without its unit.
std::string name_of(const std::string& label) {
    return label.substr(0, label.find(", "));
}

std::string names_of_curves(const Figure& figure) {
    constexpr std::size_t most = 6;
    std::string names;
    std::size_t count = 0;
    for (const Curve& curve : figure.curves) {
        if (curve.label.empty() || ++count > most) continue;
        names += (names.empty() ? "" : ", ") + curve.label;
    }
    if (count > most) names += fmt::format(" and {} more", count - most);
    return names.empty() ? name_of(figure.y.label) : names;
}

std::string what_over_what(const Figure& figure) {
    const std::string names = figure.shades != nullptr ? figure.shades->label : names_of_curves(figure);
    const std::string across = name_of(figure.x.label), up = figure.shades != nullptr ? name_of(figure.y.label) : "";
    const std::string plane = up.empty() ? across : across.empty() ? up : across + " and " + up;
    if (names.empty()) return plane.empty() ? "curves" : "curves over " + plane;
    return plane.empty() ? names : names + " over " + plane;
}

std::string range_text(const Scale& scale) {
    return fmt::format("{:.4g} to {:.4g}", scale.range().low, scale.range().high);
}

/// "x, t in s: 0 to 20. y, rad: -1.1 to 1.1. θ: a line of 2001 points. Stuck 3 times."
std::string description_of(const Figure& figure) {
    const View view = view_of(figure);
    const auto axis = [](const char* name, const Axis& a, const Scale& scale) {
        return fmt::format("{}{}{}: {}{}. ", name, a.label.empty() ? "" : ", ", a.label, range_text(scale),
                           a.logarithmic ? ", logarithmic" : "");
    };
    std::string text = axis("x", figure.x, view.x) + axis("y", figure.y, view.y);
    constexpr std::size_t most = 12;
    for (std::size_t i = 0; i < std::min(most, figure.curves.size()); ++i) {
        const Curve& curve = figure.curves[i];
        constexpr const char* kinds[] = {"a line through", "", "an area of"};
        text +=
            fmt::format("{}: {}{}{} points. ", curve.label.empty() ? "Curve" : curve.label,
                        kinds[static_cast<int>(curve.style)], curve.style == Style::points ? "" : " ", curve.size());
    }
    if (figure.curves.size() > most) text += fmt::format("{} more curves. ", figure.curves.size() - most);
    if (const std::size_t times = figure.stuck.size(); times > 0) {
        text += fmt::format("The mass was stuck {} {}. ", times, times == 1 ? "time" : "times");
    }
    text.pop_back();
    return text;
}

/// What stands between two marks of the SVG, replaced; it stays where the marks are not there.
void replace_between(std::string& svg, std::string_view from, std::string_view to, const std::string& words) {
    const std::size_t begin = svg.find(from);
    const std::size_t end = begin == std::string::npos ? begin : svg.find(to, begin);
    if (end != std::string::npos) {
        svg.replace(begin + from.size(), end - begin - from.size(), text::html(text::displayable(words)));
    }
}

}  // namespace

std::string element_of(std::string svg) {
    svg.erase(0, std::min(svg.find("<svg"), svg.size()));
    constexpr std::string_view from = "<title>gnuplot_plot_", to = "</title>";
    for (std::size_t at = svg.find(from); at != std::string::npos; at = svg.find(from, at)) {
        const std::size_t end = svg.find(to, at);
        svg.erase(at, end == std::string::npos ? end : end + to.size() - at);
    }
    return svg;
}

std::string title_of(std::span<const Figure> figures) {
    std::string title;
    for (const Figure& figure : figures) {
        const std::string own = figure.title.empty() && !figure.below ? what_over_what(figure)
                                : figure.title.empty()                ? names_of_curves(figure)
                                                                      : figure.title;
        if (!own.empty()) title += (title.empty() ? "" : "; ") + own;
    }
    return text::displayable(title);
}

std::string with_words(std::string svg, std::span<const Figure> figures) {
    const std::string title = title_of(figures);
    std::string description;
    for (const Figure& figure : figures) {
        if (!description.empty()) description += ' ';
        description += description_of(figure);
    }
    replace_between(svg, "<title>", "</title>", title);
    replace_between(svg, "<desc>", "</desc>", description);
    if (const std::size_t root = svg.find("<svg"); root != std::string::npos) {
        svg.insert(root + 4, " role=\"img\" aria-label=\"" + text::html(title) + "\"");
    }
    // gnuplot leaves > as it is in labels, and XML has this only at the end of CDATA, which gnuplot does not write.
    constexpr std::string_view end_of_data = "]]>";
    for (std::size_t at = svg.find(end_of_data); at != std::string::npos; at = svg.find(end_of_data, at)) {
        svg.replace(at, end_of_data.size(), "]]&gt;");
    }
    return svg;
}

}  // namespace dinal::plots
