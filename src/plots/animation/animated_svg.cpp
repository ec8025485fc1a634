#include "plots/animation/animated_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "text/characters.hpp"
#include "text/html.hpp"

namespace dinal::plots::animation {
namespace {

// Pixels of the sheet.
constexpr double sheet_width = 480, sheet_height = 260;
constexpr double mass_width = 44, mass_top = 56, svg_floor = 100;  // of the mass, and where it slides
constexpr double graph_left = 40, graph_right = 464, graph_top = 140, graph_bottom = 236;
constexpr double hatch_width = 12;

constexpr const char* grey_ink = "#444444";
constexpr const char* moving_colour = "#0072B2";
constexpr const char* stuck_colour = "#D55E00";

class AnimatedSvg {
public:
    explicit AnimatedSvg(const Scene& scene)
        : scene_(scene), first_(scene.spring ? 110 : 40), last_(sheet_width - (scene.walls ? 44 : 32)) {}

    std::string text() {
        const std::string title = title_of(scene_);
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{0}\" viewBox=\"0 0 {1} {2}\" "
            "width=\"{1}\" height=\"{2}\" font-family=\"Arial, sans-serif\" font-size=\"11\" fill=\"{3}\">\n<title>{0}</title>\n",
            title, sheet_width, sheet_height, grey_ink);
        add("<desc>A mass on {}{}{}; it is orange while it sticks. Below, theta over t.</desc>\n",
            scene_.belt ? "a moving belt" : "a surface with dry friction", scene_.spring ? ", with a spring" : "",
            scene_.walls ? ", between walls" : "");
        add("<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", sheet_width, sheet_height);
        add_surface();
        add_walls();
        if (scene_.spring) add_spring();
        add_mass();
        add_graph();
        return all_ + "</svg>\n";
    }

private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        all_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    }

    [[nodiscard]] double x(double theta) const { return first_ + scene_.at(theta) * (last_ - first_); }

    template <class Value>
    [[nodiscard]] std::string values(const Value& value) const {
        std::string list;
        for (const Frame& frame : scene_.frames) {
            if (!list.empty()) list += ';';
            list += value(frame);
        }
        return list;
    }

    /// animateTransform of that type over all frames.
    template <class Value>
    void add_motion(const char* attribute, const char* type, const Value& value) {
        // What plays no animations, such as a printer, shows the start: the attribute of the element that was begun.
        const std::string start = value(scene_.frames.front());
        all_.insert(all_.size() - 1, fmt::format(" {}=\"{}({})\"", attribute, type, start));
        add("<animateTransform attributeName=\"{}\" type=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            attribute, type, scene_.seconds, values(value));
    }

    void add_surface() {
        add("<defs><pattern id=\"floor\" width=\"{}\" height=\"10\" patternUnits=\"userSpaceOnUse\" y=\"{}\">",
            hatch_width, svg_floor);
        if (scene_.belt) {
            add_motion("patternTransform", "translate",
                       [&](const Frame& f) { return fmt::format("{:.1f}", scene_.shift(f) * (last_ - first_)); });
        }
        add("<path d=\"M0,10 L{},0\" stroke=\"{}\" stroke-width=\"0.8\"/>", hatch_width, grey_ink);
        add("</pattern></defs>\n<rect x=\"4\" y=\"{0}\" width=\"{1}\" height=\"10\" fill=\"url(#floor)\"/>"
            "<path d=\"M4,{0} H{2}\" stroke=\"{3}\"/>\n",
            svg_floor, sheet_width - 8, sheet_width - 4, grey_ink);
    }

    void add_walls() {
        if (!scene_.walls) return;
        constexpr double post = 6;
        if (std::isfinite(scene_.walls->lower)) {  // the spring goes past this one
            add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"12\" fill=\"{}\"/>\n",
                x(scene_.walls->lower) - mass_width / 2 - post, svg_floor - 12, post, grey_ink);
        }
        if (std::isfinite(scene_.walls->upper)) {
            add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                x(scene_.walls->upper) + mass_width / 2, mass_top, post, svg_floor - mass_top, grey_ink);
        }
    }

    /// Drawn anew for each frame: a stretched one would have stretched strokes.
    void add_spring() {
        constexpr double anchor = 8, middle = (mass_top + svg_floor) / 2 - 4, half = 9;
        const std::vector<Point> corners = spring_corners(9);
        const auto points = [&](const Frame& frame) {
            const double length = x(frame.theta) - mass_width / 2 - anchor;
            std::string list;
            for (const Point& corner : corners) {
                fmt::format_to(std::back_inserter(list), "{:.1f},{:.0f} ", anchor + length * corner.x,
                               middle + half * corner.y);
            }
            list.pop_back();
            return list;
        };
        add("<path d=\"M{},{} V{}\" stroke=\"{}\" stroke-width=\"3\"/>\n", anchor, mass_top - 4, svg_floor, grey_ink);
        add("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" points=\"{}\">", grey_ink,
            points(scene_.frames.front()));
        add("<animate attributeName=\"points\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/></polyline>\n",
            scene_.seconds, values(points));
    }

    void add_mass() {
        add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" fill=\"{}\">", -mass_width / 2, mass_top,
            mass_width, svg_floor - mass_top, moving_colour);
        add_motion("transform", "translate", [&](const Frame& f) { return fmt::format("{:.1f}", x(f.theta)); });
        add_colours();
        all_ += "</rect>\n";
    }

    /// Only where it changes.
    void add_colours() {
        std::string times, colours;
        const auto count = static_cast<double>(scene_.frames.size() - 1);
        for (std::size_t i = 0; i < scene_.frames.size(); ++i) {
            const bool stuck = scene_.frames[i].stuck;
            if (i > 0 && stuck == scene_.frames[i - 1].stuck) continue;
            times += fmt::format("{}{:.5g}", i == 0 ? "" : ";", static_cast<double>(i) / count);
            colours += fmt::format("{}{}", i == 0 ? "" : ";", stuck ? stuck_colour : moving_colour);
        }
        add("<animate attributeName=\"fill\" calcMode=\"discrete\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" keyTimes=\"{}\" "
            "values=\"{}\"/>",
            scene_.seconds, times, colours);
    }

    void add_graph() {
        const auto graph_x = [&](std::size_t i) {
            return graph_left +
                   (graph_right - graph_left) * static_cast<double>(i) / static_cast<double>(scene_.frames.size() - 1);
        };
        const auto graph_y = [&](double theta) { return graph_bottom - scene_.at(theta) * (graph_bottom - graph_top); };
        std::string path;
        for (std::size_t i = 0; i < scene_.frames.size(); ++i) {
            path += fmt::format("{}{:.1f},{:.1f}", i == 0 ? "M" : " L", graph_x(i), graph_y(scene_.frames[i].theta));
        }
        add("<path d=\"M{0},{1} V{2} H{3}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"0.8\"/>\n", graph_left,
            graph_top - 4, graph_bottom + 4, graph_right, grey_ink);
        add("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>\n", path, moving_colour);
        const auto words = [&](double at_x, double at_y, const char* anchor, const std::string& text) {
            add("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n", at_x, at_y, anchor,
                text::html(text::displayable(text)));
        };
        words(graph_left - 4, graph_top + 4, "end", fmt::format("{:.3g}", scene_.reach.high));
        words(graph_left - 4, graph_bottom + 4, "end", fmt::format("{:.3g}", scene_.reach.low));
        words(graph_left, sheet_height - 6, "middle", fmt::format("{:.6g}", scene_.frames.front().t));
        words(graph_right, sheet_height - 6, "end", fmt::format("{:.6g}", scene_.frames.back().t));
        words((graph_left + graph_right) / 2, sheet_height - 6, "middle",
              scene_.t_unit.empty() ? "t" : fmt::format("t, {}", scene_.t_unit));
        words(graph_left + 4, graph_top - 8, "start", fmt::format("θ, {}", scene_.theta_unit));
        add("<circle r=\"3.5\" fill=\"{}\">", stuck_colour);
        add_motion("transform", "translate", [&](const Frame& f) {
            const auto place = static_cast<std::size_t>(&f - scene_.frames.data());
            return fmt::format("{:.1f},{:.1f}", graph_x(place), graph_y(f.theta));
        });
        all_ += "</circle>\n";
    }

    const Scene& scene_;
    const double first_, last_;  // of the middle of the mass
    std::string all_;
};

}  // namespace

std::string title_of(const Scene& scene) {
    return fmt::format("A run in motion, t = {:.6g} to {:.6g}", scene.frames.front().t, scene.frames.back().t);
}

std::string animated_svg(const Scene& scene) {
    return AnimatedSvg(scene).text();
}

}  // namespace dinal::plots::animation
