#include "plots/svg_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "plots/figure.hpp"
#include "plots/shades.hpp"
#include "text/characters.hpp"

namespace dinal::plots {
namespace {

/// The label without its unit: "θ" for "θ, rad".
std::string name_of(const std::string& label) {
    return label.substr(0, label.find(", "));
}

std::string names_of_curves(const Figure& figure) {
    constexpr std::size_t most = 3;  // more curves are described by the label of the axis only
    std::string names;
    std::size_t count = 0;
    for (const Curve& curve : figure.curves) {
        if (curve.label.empty()) continue;
        if (++count <= most) names += (names.empty() ? "" : ", ") + curve.label;
    }
    const std::string axis = name_of(figure.y.label);
    if (count > most) return axis.empty() ? names + fmt::format(" and {} more", count - most) : axis;
    return names.empty() ? axis : names;
}

std::string what_over_what(const Figure& figure) {
    const std::string names = figure.shades != nullptr ? figure.shades->label : names_of_curves(figure);
    const std::string across = name_of(figure.x.label), up = figure.shades != nullptr ? name_of(figure.y.label) : "";
    const std::string plane = up.empty() ? across : across.empty() ? up : across + " and " + up;
    if (names.empty()) return plane.empty() ? "curves" : "curves over " + plane;
    return plane.empty() ? names : names + " over " + plane;
}

// ---- description of a curve

/// Describes the swings between these extremes, without the half swings at both ends.
std::string swings_text(const std::vector<double>& turns) {
    constexpr std::size_t fewest = 5;
    if (turns.size() < fewest) return "";
    const auto swing = [&turns](std::size_t i) { return std::fabs(turns[i + 1] - turns[i]); };
    const double first = swing(1), last = swing(turns.size() - 3);
    double largest = 0;
    for (std::size_t i = 1; i + 2 < turns.size(); ++i) largest = std::max(largest, swing(i));
    constexpr double clearly = 1.2;
    const char* trend = largest > clearly * std::max(first, last) ? "that grow and decay"
                        : last > clearly * first                  ? "that grow"
                        : last < first / clearly                  ? "that decay"
                                                                  : "of about equal size";
    return fmt::format(", {} half swings {}", turns.size() - 1, trend);
}

std::string course_over_x(const std::vector<Point>& points) {
    const auto [low, high] = std::ranges::minmax_element(points, {}, &Point::y);
    const double from = points.front().y, to = points.back().y;
    if (low->y == high->y) return fmt::format("constant at {:.4g}", from);
    constexpr double visible = 0.01;  // fraction of the height
    std::vector<double> up, turns;
    for (const Point& point : points) up.push_back(point.y);
    for (const std::size_t i : turns_of(up, visible * (high->y - low->y))) turns.push_back(up[i]);
    if (turns.size() == 2) return fmt::format("{} from {:.4g} to {:.4g}", to > from ? "rises" : "falls", from, to);
    return fmt::format("from {:.4g} to {:.4g}, greatest {:.4g} at {:.4g}, least {:.4g} at {:.4g}{}", from, to, high->y,
                       high->x, low->y, low->x, swings_text(turns));
}

/// Describes the visible part of a curve from left to right; of an area both edges.
std::string course_of(const View& view, const Curve& curve) {
    std::vector<Point> points;
    const Interval across = view.x.range();
    for (std::size_t i = 0; i < curve.size(); ++i) {
        const double x = curve.x.values[i], y = curve.y.values[i];
        if (!view.x.has(x) || !view.y.has(y) || x < across.low || x > across.high) continue;
        points.push_back({x, y});
        if (curve.style == Style::fill) points.push_back({x, curve.base ? curve.base->values[i] : 0});
    }
    if (points.empty()) return "";
    const auto by_x = [](const Point& a, const Point& b) { return a.x < b.x; };
    const auto by_y = [](const Point& a, const Point& b) { return a.y < b.y; };
    const Point from = points.front(), to = points.back();
    if (points.size() == 1) return fmt::format("a point at ({:.4g}, {:.4g})", from.x, from.y);
    const auto [left, right] = std::ranges::minmax_element(points, by_x);
    const auto [low, high] = std::ranges::minmax_element(points, by_y);
    const std::string box =
        fmt::format("across from {:.4g} to {:.4g}, up from {:.4g} to {:.4g}", left->x, right->x, low->y, high->y);
    if (curve.style == Style::fill) return "an area " + box;
    if (curve.style == Style::points) return fmt::format("{} points, {}", points.size(), box);
    if (std::ranges::is_sorted(points, by_x)) return course_over_x(points);
    return fmt::format("a path from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}), {}", from.x, from.y, to.x, to.y, box);
}

std::string stuck_text(const std::vector<Interval>& stuck) {
    if (stuck.empty()) return "";
    const auto span = [](const Interval& s) { return fmt::format("from {:.4g} to {:.4g}", s.low, s.high); };
    if (stuck.size() == 1) return fmt::format("Stuck {}. ", span(stuck.front()));
    return fmt::format("Stuck {} times, first {}, last {}. ", stuck.size(), span(stuck.front()), span(stuck.back()));
}

std::string map_text(const Shades& shades) {
    std::size_t low = shades.z.size(), high = low;
    for (std::size_t i = 0; i < shades.z.size(); ++i) {
        if (!std::isfinite(shades.z[i])) continue;
        if (low == shades.z.size() || shades.z[i] < shades.z[low]) low = i;
        if (high == shades.z.size() || shades.z[i] > shades.z[high]) high = i;
    }
    if (low == shades.z.size()) return "";
    const auto at = [&shades](std::size_t i) {
        return fmt::format("{:.4g} at ({:.4g}, {:.4g})", shades.z[i], shades.x[i % shades.x.size()],
                           shades.y[i / shades.x.size()]);
    };
    return fmt::format("A map of {}: least {}, greatest {}. ", shades.label.empty() ? "values" : shades.label, at(low),
                       at(high));
}

/// "Across: t, s, 0 to 20. Up: θ, rad, -1.1 to 1.1. θ: from 1 to -0.03, greatest 1 at 0, ... Stuck from 5 to 20."
std::string description_of(const Figure& figure) {
    const View view = view_of(figure);
    const auto axis = [](const char* name, const Axis& a, const Scale& scale) {
        return fmt::format("{}: {}{}{:.4g} to {:.4g}{}. ", name, a.label, a.label.empty() ? "" : ", ",
                           scale.range().low, scale.range().high, a.logarithmic ? ", logarithmic" : "");
    };
    std::string text = axis("Across", figure.x, view.x) + axis("Up", figure.y, view.y);
    if (figure.shades != nullptr) text += map_text(*figure.shades);
    constexpr std::size_t most = 12;
    std::size_t described = 0;
    const std::string alone = figure.curves.size() == 1 ? name_of(figure.y.label) : "";
    for (const Curve& curve : figure.curves) {
        const std::string course = course_of(view, curve);
        if (course.empty() || ++described > most) continue;
        const std::string& name = curve.label.empty() ? alone : curve.label;
        text += fmt::format("{}: {}. ", name.empty() ? "Curve" : name, course);
    }
    if (described > most) text += fmt::format("{} more curves. ", described - most);
    if (figure.dead_zone) {
        text += fmt::format("Dead zone from {:.4g} to {:.4g}. ", figure.dead_zone->low, figure.dead_zone->high);
    }
    text += stuck_text(figure.stuck);
    text.pop_back();
    return text;
}

}  // namespace

std::string element_of(std::string svg) {
    svg.erase(0, std::min(svg.find("<svg"), svg.size()));
    const std::string own = fmt::format("p{:x}-", std::hash<std::string>()(svg));
    for (const std::string_view mark : {"id=\"", "href=\"#", "url(#"}) {
        for (std::size_t at = svg.find(mark); at != std::string::npos; at = svg.find(mark, at + own.size())) {
            svg.insert(at += mark.size(), own);
        }
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
        if (figures.size() > 1) description += fmt::format("Panel {}. ", &figure - figures.data() + 1);
        description += description_of(figure);
    }
    const std::size_t root = svg.find("<svg") + 4;
    svg.insert(svg.find('>', root) + 1, fmt::format("\n<title>{}</title>\n<desc>{}</desc>", text::html(title),
                                                    text::html(text::displayable(description))));
    svg.insert(root, fmt::format(" role=\"img\" aria-label=\"{}\"", text::html(title)));
    return svg;
}

}  // namespace dinal::plots
