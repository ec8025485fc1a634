#include "plots/animation/animated_svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "text/characters.hpp"
#include "text/html.hpp"

namespace dinal::plots::animation {
namespace {

// Pixels of the sheet.
constexpr double sheet_width = 480, sheet_height = 260;
constexpr double mass_width = 44, mass_top = 56, svg_floor = 100;  // of the mass, and where it slides

/// The box in which theta is drawn over t.
struct Graph {
    double left, right, top, bottom;
};
constexpr double hatch_width = 12;

constexpr const char* grey_ink = "#444444";
constexpr const char* moving_colour = "#0072B2";
constexpr const char* stuck_colour = "#D55E00";

/// A sheet, and what moves on it.
class Sheet {
protected:
    explicit Sheet(const Scene& clock) : clock_(clock) {}

    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        all_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    }

    void begin(double width, double height, const std::string& seen) {
        const std::string title = title_of(clock_);
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{0}\" viewBox=\"0 0 {1} {2}\" "
            "width=\"{1}\" height=\"{2}\" font-family=\"Arial, sans-serif\" font-size=\"11\" fill=\"{3}\">\n<title>{0}</title>\n",
            title, width, height, grey_ink);
        const Frame &first = clock_.frames.front(), &last = clock_.frames.back();
        const std::string axes = fmt::format(" Below, θ from {:.3g} to {:.3g} over t from {:.6g} to {:.6g}.",
                                             clock_.reach.low, clock_.reach.high, first.t, last.t);
        add("<desc>{}</desc>\n<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", text::html(seen + axes), width,
            height);
    }

    template <class Value>
    [[nodiscard]] static std::string values(const Scene& scene, const Value& value) {
        std::string list;
        for (const Frame& frame : scene.frames) {
            if (!list.empty()) list += ';';
            list += value(frame);
        }
        return list;
    }

    /// animateTransform of that type over all frames.
    template <class Value>
    void add_motion(const char* attribute, const char* type, const Scene& scene, const Value& value) {
        // What plays no animations, such as a printer, shows the start: the attribute of the element that was begun.
        const std::string start = value(scene.frames.front());
        all_.insert(all_.size() - 1, fmt::format(" {}=\"{}({})\"", attribute, type, start));
        add("<animateTransform attributeName=\"{}\" type=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            attribute, type, clock_.seconds, values(scene, value));
    }

    /// Only where it changes.
    void add_colours(const char* attribute, const Scene& scene, const char* moving) {
        std::string times, colours;
        const auto count = static_cast<double>(scene.frames.size() - 1);
        for (std::size_t i = 0; i < scene.frames.size(); ++i) {
            const bool stuck = scene.frames[i].stuck;
            if (i > 0 && stuck == scene.frames[i - 1].stuck) continue;
            times += fmt::format("{}{:.5g}", i == 0 ? "" : ";", static_cast<double>(i) / count);
            colours += fmt::format("{}{}", i == 0 ? "" : ";", stuck ? stuck_colour : moving);
        }
        add("<animate attributeName=\"{}\" calcMode=\"discrete\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" keyTimes=\"{}\" "
            "values=\"{}\"/>",
            attribute, clock_.seconds, times, colours);
    }

    void words(double at_x, double at_y, const char* anchor, const std::string& text, const char* colour = grey_ink) {
        add("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", at_x, at_y, anchor, colour,
            text::html(text::displayable(text)));
    }

    /// A line of so many corners that is drawn anew for each frame: a stretched one would have stretched strokes.
    template <class Points>
    void add_line(const std::string& style, const Scene& scene, const Points& points) {
        add("<polyline fill=\"none\" {} points=\"{}\">", style, points(scene.frames.front()));
        add("<animate attributeName=\"points\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            clock_.seconds, values(scene, points));
    }
    /// From one place to another, at this height.
    [[nodiscard]] static std::string spring_points(double from, double to, double middle, double half) {
        std::string list;
        for (const Point& corner : spring_corners(9)) {
            fmt::format_to(std::back_inserter(list), "{:.1f},{:.0f} ", from + (to - from) * corner.x,
                           middle + half * corner.y);
        }
        list.pop_back();
        return list;
    }

    [[nodiscard]] double graph_x(const Graph& graph, std::size_t frame) const {
        return graph.left +
               (graph.right - graph.left) * static_cast<double>(frame) / static_cast<double>(clock_.frames.size() - 1);
    }
    [[nodiscard]] static double graph_y(const Graph& graph, const Scene& scene, double theta) {
        return graph.bottom - scene.at(theta) * (graph.bottom - graph.top);
    }

    /// With the numbers at their ends and their names.
    void add_axes(const Graph& graph) {
        add("<path d=\"M{0},{1} V{2} H{3}\" fill=\"none\" stroke=\"{4}\" stroke-width=\"0.8\"/>\n", graph.left,
            graph.top - 4, graph.bottom + 4, graph.right, grey_ink);
        words(graph.left - 4, graph.top + 4, "end", fmt::format("{:.3g}", clock_.reach.high));
        words(graph.left - 4, graph.bottom + 4, "end", fmt::format("{:.3g}", clock_.reach.low));
        const double below = graph.bottom + 18;
        words(graph.left, below, "middle", fmt::format("{:.6g}", clock_.frames.front().t));
        words(graph.right, below, "end", fmt::format("{:.6g}", clock_.frames.back().t));
        words((graph.left + graph.right) / 2, below, "middle",
              clock_.t_unit.empty() ? "t" : fmt::format("t, {}", clock_.t_unit));
        words(graph.left + 4, graph.top - 8, "start", fmt::format("θ, {}", clock_.theta_unit));
    }

    void add_curve(const Graph& graph, const Scene& scene, const char* colour) {
        std::string path;
        for (std::size_t i = 0; i < scene.frames.size(); ++i) {
            path += fmt::format("{}{:.1f},{:.1f}", i == 0 ? "M" : " L", graph_x(graph, i),
                                graph_y(graph, scene, scene.frames[i].theta));
        }
        add("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>\n", path, colour);
    }

    const Scene& clock_;
    std::string all_;
};

class AnimatedSvg : Sheet {
public:
    explicit AnimatedSvg(const Scene& scene)
        : Sheet(scene), scene_(scene), first_(scene.spring ? 110 : 40), last_(sheet_width - (scene.walls ? 44 : 32)) {}

    std::string text() {
        begin(sheet_width, sheet_height,
              fmt::format("A mass on {}{}{}: it starts at θ = {:.3g}, ends at {:.3g} and is orange while it sticks.",
                          scene_.belt ? "a moving belt" : "a surface with dry friction",
                          scene_.spring ? ", with a spring" : "", scene_.walls ? ", between walls" : "",
                          scene_.frames.front().theta, scene_.frames.back().theta));
        add_surface();
        add_walls();
        if (scene_.spring) add_spring();
        add_mass();
        add_graph();
        return all_ + "</svg>\n";
    }

private:
    [[nodiscard]] double x(double theta) const { return first_ + scene_.at(theta) * (last_ - first_); }

    void add_surface() {
        add("<defs><pattern id=\"floor\" width=\"{}\" height=\"10\" patternUnits=\"userSpaceOnUse\" y=\"{}\">",
            hatch_width, svg_floor);
        if (scene_.belt) {
            add_motion("patternTransform", "translate", scene_,
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

    void add_spring() {
        constexpr double anchor = 8, middle = (mass_top + svg_floor) / 2 - 4;
        add("<path d=\"M{},{} V{}\" stroke=\"{}\" stroke-width=\"3\"/>\n", anchor, mass_top - 4, svg_floor, grey_ink);
        add_line(fmt::format("stroke=\"{}\" stroke-width=\"1.3\"", grey_ink), scene_,
                 [&](const Frame& frame) { return spring_points(anchor, x(frame.theta) - mass_width / 2, middle, 9); });
        all_ += "</polyline>\n";
    }

    void add_mass() {
        add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" fill=\"{}\">", -mass_width / 2, mass_top,
            mass_width, svg_floor - mass_top, moving_colour);
        add_motion("transform", "translate", scene_, [&](const Frame& f) { return fmt::format("{:.1f}", x(f.theta)); });
        add_colours("fill", scene_, moving_colour);
        all_ += "</rect>\n";
    }

    void add_graph() {
        constexpr Graph graph{40, 464, 140, 236};
        add_axes(graph);
        add_curve(graph, scene_, moving_colour);
        add("<circle r=\"3.5\" fill=\"{}\">", stuck_colour);
        add_motion("transform", "translate", scene_, [&](const Frame& f) {
            const auto frame = static_cast<std::size_t>(&f - scene_.frames.data());
            return fmt::format("{:.1f},{:.1f}", graph_x(graph, frame), graph_y(graph, scene_, f.theta));
        });
        all_ += "</circle>\n";
    }

    const Scene& scene_;
    const double first_, last_;  // of the middle of the mass
};

/// Several bodies, each in a cell of its own.
class RigSvg : Sheet {
public:
    explicit RigSvg(const RigScene& rig)
        : Sheet(rig.bodies.front()),
          rig_(rig),
          cell_(std::max(most_cell / std::sqrt(static_cast<double>(rig.bodies.size())), least_cell)),
          width_(std::max(sheet_width, cell_ * static_cast<double>(rig.bodies.size()) + 2 * margin)) {}

    std::string text() {
        begin(width_, tall,
              fmt::format("{} bodies {}; bodies and links are orange while they stick.", rig_.bodies.size(),
                          rig_.discs ? "as discs on one axis" : "side by side"));
        for (std::size_t i = 0; i < rig_.bodies.size() && !rig_.discs; ++i) add_floor(i);
        for (std::size_t k = 0; k < rig_.links.size(); ++k) add_link(rig_.links[k], k);
        for (std::size_t i = 0; i < rig_.bodies.size(); ++i) rig_.discs ? add_disc(i) : add_block(i);
        add_graph();
        return all_ + "</svg>\n";
    }

private:
    static constexpr double margin = 20, tall = 330, least_cell = 76, most_cell = 240;
    static constexpr double block = 36, top = 74, floor = 106, middle = 86, radius = 30;
    static constexpr const char* colours[] = {"#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};

    [[nodiscard]] const char* colour(std::size_t i) const { return colours[i % std::size(colours)]; }
    [[nodiscard]] double centre(std::size_t i) const {
        const double all = cell_ * static_cast<double>(rig_.bodies.size());
        return (width_ - all) / 2 + cell_ * (static_cast<double>(i) + 0.5);
    }
    /// The springs on the left keep some room.
    [[nodiscard]] double travel() const { return std::max(cell_ - block - 44, 8.0); }
    [[nodiscard]] double shift(double theta) const {
        const Interval& reach = rig_.bodies.front().reach;
        return (theta - (reach.low + reach.high) / 2) / reach.length() * travel();
    }
    [[nodiscard]] double x(std::size_t i, const Frame& frame) const {
        return rig_.discs ? centre(i) : centre(i) + 12 + shift(frame.theta);
    }

    void add_floor(std::size_t i) {
        const Scene& body = rig_.bodies[i];
        add("<defs><pattern id=\"floor{}\" width=\"{}\" height=\"8\" patternUnits=\"userSpaceOnUse\" y=\"{}\">", i,
            hatch_width, floor);
        if (body.belt) {
            add_motion("patternTransform", "translate", body,
                       [&](const Frame& f) { return fmt::format("{:.1f}", body.shift(f) * travel()); });
        }
        add("<path d=\"M0,8 L{},0\" stroke=\"{}\" stroke-width=\"0.8\"/></pattern></defs>\n", hatch_width, grey_ink);
        add("<rect x=\"{0:.1f}\" y=\"{1}\" width=\"{2:.1f}\" height=\"8\" fill=\"url(#floor{3})\"/>"
            "<path d=\"M{0:.1f},{1} h{2:.1f}\" stroke=\"{4}\" stroke-width=\"{5}\"/>\n",
            centre(i) - cell_ / 2 + 1, floor, cell_ - 2, i, grey_ink, body.belt ? 2.5 : 1);
        if (!body.spring) return;
        const double anchor = centre(i) - cell_ / 2 + 3;
        add("<path d=\"M{:.1f},{} V{}\" stroke=\"{}\" stroke-width=\"2\"/>\n", anchor, floor - 12, floor, grey_ink);
        add_line(fmt::format("stroke=\"{}\" stroke-width=\"0.9\"", grey_ink), body,
                 [&](const Frame& f) { return spring_points(anchor, x(i, f) - block / 2, floor - 6, 3); });
        all_ += "</polyline>\n";
    }

    void add_block(std::size_t i) {
        add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"3\" fill=\"{}\">", -block / 2, top, block,
            floor - top, colour(i));
        add_motion("transform", "translate", rig_.bodies[i],
                   [&](const Frame& f) { return fmt::format("{:.1f}", x(i, f)); });
        add_colours("fill", rig_.bodies[i], colour(i));
        all_ += "</rect>\n";
        words(centre(i), floor + 24, "middle", rig_.bodies[i].name, colour(i));
    }

    /// Seen from its face, with a mark that goes round.
    void add_disc(std::size_t i) {
        add("<circle cx=\"{:.1f}\" cy=\"{}\" r=\"{}\" fill=\"{}\">", centre(i), middle, radius, colour(i));
        add_colours("fill", rig_.bodies[i], colour(i));
        all_ += "</circle>\n";
        const double at = centre(i);
        add("<path d=\"M{:.1f},{} V{}\" stroke=\"#ffffff\" stroke-width=\"4\">", at, middle, middle + 3 - radius);
        add_motion("transform", "rotate", rig_.bodies[i], [at](const Frame& f) {
            return fmt::format("{:.1f},{:.1f},{}", f.theta * 180 / std::numbers::pi, at, middle);
        });
        all_ += "</path>\n";
        words(centre(i), middle + radius + 16, "middle", rig_.bodies[i].name, colour(i));
    }

    /// Between neighbours straight, past others above them.
    void add_link(const RigScene::Link& link, std::size_t k) {
        const std::size_t left = std::min(link.first, link.second), right = std::max(link.first, link.second);
        const Scene &a = rig_.bodies[left], &b = rig_.bodies[right];
        const double half = rig_.discs ? radius : block / 2;
        const double above = 12 + 9 * static_cast<double>(k % 5);
        const bool direct = right == left + 1 && first_between(left, k);
        const auto points = [&](const Frame& frame) {
            const auto at = static_cast<std::size_t>(&frame - link.scene.frames.data());
            const double from = x(left, a.frames[at]), to = x(right, b.frames[at]);
            if (direct && link.scene.spring) return spring_points(from + half, to - half, middle, 6);
            if (direct) return fmt::format("{:.1f},{} {:.1f},{}", from + half, middle, to - half, middle);
            return fmt::format("{0:.1f},{1} {0:.1f},{2} {3:.1f},{2} {3:.1f},{1}", from, top, above, to);
        };
        add_line(fmt::format("stroke=\"{}\" stroke-width=\"{}\"", grey_ink, link.scene.spring ? 1.2 : 3), link.scene,
                 points);
        add_colours("stroke", link.scene, grey_ink);
        all_ += "</polyline>\n";
        direct ? words((centre(left) + centre(right)) / 2, middle - 14, "middle", link.scene.name)
               : words((centre(left) + centre(right)) / 2, above - 2, "middle", link.scene.name);
    }
    /// Two links between the same bodies would hide each other.
    [[nodiscard]] bool first_between(std::size_t left, std::size_t k) const {
        return std::none_of(rig_.links.begin(), rig_.links.begin() + static_cast<std::ptrdiff_t>(k),
                            [left](const RigScene::Link& other) {
                                return std::min(other.first, other.second) == left &&
                                       std::max(other.first, other.second) == left + 1;
                            });
    }

    void add_graph() {
        const Graph graph{40, width_ - 16, 160, 306};
        add_axes(graph);
        for (std::size_t i = 0; i < rig_.bodies.size(); ++i) add_curve(graph, rig_.bodies[i], colour(i));
        add("<path d=\"M0,{} V{}\" stroke=\"{}\" stroke-width=\"1.2\">", graph.top - 4, graph.bottom + 4, stuck_colour);
        add_motion("transform", "translate", clock_, [&](const Frame& f) {
            return fmt::format("{:.1f}", graph_x(graph, static_cast<std::size_t>(&f - clock_.frames.data())));
        });
        all_ += "</path>\n";
    }

    const RigScene& rig_;
    const double cell_, width_;
};

}  // namespace

std::string title_of(const Scene& scene) {
    return fmt::format("A run in motion, t = {:.6g} to {:.6g}", scene.frames.front().t, scene.frames.back().t);
}

std::string animated_svg(const RigScene& rig) {
    return RigSvg(rig).text();
}

std::string animated_svg(const Scene& scene) {
    return AnimatedSvg(scene).text();
}

}  // namespace dinal::plots::animation
