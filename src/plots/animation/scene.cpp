#include "plots/animation/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <string_view>
#include <utility>

#include "plots/ticks.hpp"
#include "text/characters.hpp"
#include "text/html.hpp"

namespace dinal::plots::animation {

namespace {

/// The displacement of the surface between two times, by Simpson's rule.
double way_of(const model::Excitation& belt, double from, double to) {
    return (to - from) / 6 * (belt.value(from) + 4 * belt.value((from + to) / 2) + belt.value(to));
}

bool is_stuck(const std::vector<Interval>& stuck, double t) {
    const auto next = std::upper_bound(stuck.begin(), stuck.end(), t,
                                       [](double time, const Interval& interval) { return time < interval.low; });
    return next != stuck.begin() && t <= std::prev(next)->high;
}

Interval reach_of(const std::vector<Frame>& frames, const motion::Run& run, const std::optional<model::Walls>& walls) {
    Interval reach{frames.front().theta, frames.front().theta};
    const auto include = [&](double t, double theta) {
        if (t < frames.front().t || t > frames.back().t) return;
        reach = {std::min(reach.low, theta), std::max(reach.high, theta)};
    };
    for (const Frame& frame : frames) include(frame.t, frame.theta);
    // Extremes lie between frames: include the turns, which a computed run knows.
    for (const model::Event& event : run.events) include(event.t, event.theta);
    const auto t = run.find("t"), theta = run.find("theta");
    for (Eigen::Index i = 0; t && theta && i < run.size(); ++i) include(run.rows(i, *t), run.rows(i, *theta));
    if (walls) {
        reach.low = std::isfinite(walls->lower) ? std::min(reach.low, walls->lower) : reach.low;
        reach.high = std::isfinite(walls->upper) ? std::max(reach.high, walls->upper) : reach.high;
    }
    const double size = std::max(std::fabs(reach.low), std::fabs(reach.high));
    if (reach.length() <= 1e-9 * size || reach.length() < shortest_axis) {  // it never moved
        const double half = size > 10 * shortest_axis ? size / 2 : 1;
        return {reach.low - half, reach.high + half};
    }
    return reach;
}

}  // namespace

text::Expected<Scene> scene_of(const RunData& run, const model::Excitation* belt, const Take& take,
                               const std::function<bool()>& go_on) {
    Scene scene;
    scene.seconds = take.seconds;
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(take.count())));
    const std::vector<Interval> stuck = stuck_intervals(*run.result);
    Frame frame;
    for (std::size_t i = 0; i <= count; ++i) {
        if (!go_on()) return text::Error{"the animation was interrupted"};
        const double t = i == count
                             ? take.to
                             : take.from + (take.to - take.from) * static_cast<double>(i) / static_cast<double>(count);
        const auto state = run.result->at(t);
        if (!state) return state.error();
        if (belt != nullptr && i > 0) frame.surface += way_of(*belt, frame.t, t);
        frame.t = t;
        frame.theta = state->theta;
        frame.stuck = is_stuck(stuck, t);
        scene.frames.push_back(frame);
    }
    scene.belt = belt != nullptr;
    scene.theta_unit = run.units.theta;
    scene.t_unit = run.units.t;
    if (run.system) {
        scene.walls = run.system->walls();
        scene.spring = run.system->has_spring() || !run.system->spring().none();
    }
    scene.reach = reach_of(scene.frames, *run.result, scene.walls);
    return scene;
}

RigScene side_by_side(std::vector<Scene> bodies, std::vector<RigScene::Link> links) {
    RigScene rig;
    std::vector<std::size_t> place(bodies.size(), bodies.size());  // the new position of each body
    const auto is_end = [&](std::size_t i) {
        return std::count_if(links.begin(), links.end(),
                             [i](const RigScene::Link& link) { return link.first == i || link.second == i; }) < 2;
    };
    const auto put = [&](std::size_t i) {
        place[i] = rig.bodies.size();
        rig.bodies.push_back(std::move(bodies[i]));
    };
    while (rig.bodies.size() < bodies.size()) {
        std::size_t next = bodies.size();
        for (std::size_t i = bodies.size(); i-- > 0;) {
            if (place[i] == bodies.size() && (next == bodies.size() || is_end(i) || !is_end(next))) next = i;
        }
        put(next);
        for (bool found = true; found;) {
            found = false;
            for (const RigScene::Link& link : links) {
                const std::size_t last = rig.bodies.size() - 1;
                const bool from_first = place[link.first] == last, from_second = place[link.second] == last;
                const std::size_t other = from_first ? link.second : link.first;
                if ((!from_first && !from_second) || place[other] != bodies.size()) continue;
                put(other);
                found = true;
                break;
            }
        }
    }
    for (RigScene::Link& link : links) link.first = place[link.first], link.second = place[link.second];
    rig.links = std::move(links);
    Interval all = rig.bodies.front().reach;
    for (const Scene& body : rig.bodies) {
        all = {std::min(all.low, body.reach.low), std::max(all.high, body.reach.high)};
    }
    constexpr double turn = 2 * std::numbers::pi;
    rig.discs = all.length() > turn;
    for (Scene& body : rig.bodies) body.reach = all;
    return rig;
}

std::vector<Point> spring_corners(int windings) {
    constexpr double straight = 0.06;  // straight part at each end, relative to the length
    std::vector<Point> corners{{0, 0}, {straight, 0}};
    for (int i = 0; i < 2 * windings; ++i) {
        corners.push_back({straight + (1 - 2 * straight) * (i + 0.5) / (2 * windings), i % 2 == 0 ? 1.0 : -1.0});
    }
    corners.push_back({1 - straight, 0});
    corners.push_back({1, 0});
    return corners;
}

namespace {

constexpr double sheet_width = 480;  // pixels; wider for many bodies

/// The box of theta over t.
struct Graph {
    double left, right, top, bottom;
};
constexpr double hatch_width = 12;

constexpr const char* grey_ink = "#444444";
constexpr const char* stuck_colour = "#D55E00";

/// An SVG sheet and its moving parts.
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

    /// Adds animateTransform of this type over all frames.
    template <class Value>
    void add_motion(const char* attribute, const char* type, const Scene& scene, const Value& value) {
        // Viewers without animation, such as a printer, show the initial attribute.
        const std::string start = value(scene.frames.front());
        all_.insert(all_.size() - 1, fmt::format(" {}=\"{}({})\"", attribute, type, start));
        add("<animateTransform attributeName=\"{}\" type=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            attribute, type, clock_.seconds, values(scene, value));
    }

    /// Adds colour changes only where they occur.
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

    /// A polyline redrawn in each frame: scaling would distort its strokes.
    template <class Points>
    void add_line(const std::string& style, const Scene& scene, const Points& points) {
        add("<polyline fill=\"none\" {} points=\"{}\">", style, points(scene.frames.front()));
        add("<animate attributeName=\"points\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            clock_.seconds, values(scene, points));
    }
    /// The corners of a spring between two places, at this height.
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

    /// Axes with their names and the numbers at their ends.
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

/// One or several bodies, each in its own cell.
class RigSvg : Sheet {
public:
    explicit RigSvg(const RigScene& rig)
        : Sheet(rig.bodies.front()),
          rig_(rig),
          alone_(rig.bodies.size() == 1),
          cell_(alone_ ? sheet_width - 2 * margin
                       : std::max(most_cell / std::sqrt(static_cast<double>(rig.bodies.size())), least_cell)),
          width_(std::max(sheet_width, cell_ * static_cast<double>(rig.bodies.size()) + 2 * margin)) {}

    std::string text() {
        begin(width_, tall,
              alone_ ? of_one_mass()
                     : fmt::format("{} bodies {}; bodies and links are orange while they stick.", rig_.bodies.size(),
                                   rig_.discs ? "as discs on one axis" : "side by side"));
        for (std::size_t i = 0; i < rig_.bodies.size() && !rig_.discs; ++i) add_floor(i);
        for (std::size_t k = 0; k < rig_.links.size(); ++k) add_link(rig_.links[k], k);
        for (std::size_t i = 0; i < rig_.bodies.size(); ++i) rig_.discs ? add_disc(i) : add_block(i);
        add_graph();
        return all_ + "</svg>\n";
    }

private:
    static constexpr double margin = 20, tall = 330, least_cell = 76, most_cell = 240;
    static constexpr double block = 36, post = 6, top = 74, floor = 106, middle = 86, radius = 30;
    static constexpr const char* colours[] = {"#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};

    [[nodiscard]] std::string of_one_mass() const {
        return fmt::format("A mass on {}{}{}: it starts at θ = {:.3g}, ends at {:.3g} and is orange while it sticks.",
                           clock_.belt ? "a moving belt" : "a surface with dry friction",
                           clock_.spring ? ", with a spring" : "", clock_.walls ? ", between walls" : "",
                           clock_.frames.front().theta, clock_.frames.back().theta);
    }

    [[nodiscard]] const char* colour(std::size_t i) const { return colours[i % std::size(colours)]; }
    [[nodiscard]] double centre(std::size_t i) const {
        const double all = cell_ * static_cast<double>(rig_.bodies.size());
        return (width_ - all) / 2 + cell_ * (static_cast<double>(i) + 0.5);
    }
    /// The travel of a block, with room for the spring on the left.
    [[nodiscard]] double travel() const { return std::max(cell_ - block - 44, 8.0); }
    [[nodiscard]] double shift(double theta) const {
        const Interval& reach = rig_.bodies.front().reach;
        return (theta - (reach.low + reach.high) / 2) / reach.length() * travel();
    }
    [[nodiscard]] double x_of(std::size_t i, double theta) const { return centre(i) + 12 + shift(theta); }
    [[nodiscard]] double x(std::size_t i, const Frame& frame) const {
        return rig_.discs ? centre(i) : x_of(i, frame.theta);
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
        for (const auto& [wall, at] : {std::pair(body.walls ? body.walls->lower : INFINITY, -block / 2 - post),
                                       std::pair(body.walls ? body.walls->upper : INFINITY, block / 2)}) {
            if (!std::isfinite(wall)) continue;
            add("<rect x=\"{:.1f}\" y=\"{}\" width=\"{}\" height=\"12\" fill=\"{}\"/>\n", x_of(i, wall) + at,
                floor - 12, post, grey_ink);  // the spring passes it
        }
        if (!body.spring) return;
        const double anchor = centre(i) - cell_ / 2 + 3;
        add("<path d=\"M{:.1f},{} V{}\" stroke=\"{}\" stroke-width=\"2\"/>\n", anchor, floor - 12, floor, grey_ink);
        add_line(fmt::format("stroke=\"{}\" stroke-width=\"0.9\"", grey_ink), body, [&](const Frame& f) {
            return spring_points(anchor, x(i, f) - block / 2, alone_ ? floor - 16 : floor - 6, alone_ ? 8 : 3);
        });
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

    /// A disc with a rotating mark.
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

    /// A link: straight between neighbours, otherwise above the bodies between.
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
    /// Returns whether no earlier link connects the same bodies, as it would hide this one.
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
    const bool alone_;
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
    const RigScene alone{.bodies = {scene}, .links = {}};
    return RigSvg(alone).text();
}

namespace {

struct FrameSigns {
    std::string_view mass, stuck, anchor, wall, coil[2], surface[4];
};

constexpr FrameSigns of_unicode{"█", "▓", "▐", "▌", {"/", "\\"}, {"─", "─", "─", "╱"}};
constexpr FrameSigns of_ascii{"#", "X", "|", "|", {"/", "\\"}, {"-", "-", "-", "/"}};

/// A row of cells, each one column wide.
class Row {
public:
    explicit Row(int columns) : cells_(static_cast<std::size_t>(std::max(columns, 0)), " ") {}
    void put(int column, std::string_view sign) {
        if (column >= 0 && column < static_cast<int>(cells_.size())) cells_[static_cast<std::size_t>(column)] = sign;
    }
    void fill(int from, int to, std::string_view sign) {
        for (int column = from; column < to; ++column) put(column, sign);
    }
    void write(int column, std::string_view ascii) {
        for (std::size_t i = 0; i < ascii.size(); ++i) put(column + static_cast<int>(i), ascii.substr(i, 1));
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const std::string_view cell : cells_) all += cell;
        all.erase(all.find_last_not_of(' ') + 1);
        return all;
    }

private:
    std::vector<std::string_view> cells_;
};

/// Columns: width of the mass, and its centre at both ends of its reach.
struct Places {
    int mass, first, last;
    [[nodiscard]] double middle(double part) const { return first + part * (last - first); }
};

Places places_of(const Scene& scene, int columns) {
    constexpr int narrow = 40;
    const int mass = columns < narrow ? 3 : 5;
    const int shortest_spring = columns < narrow ? 4 : 8;
    const int first = (scene.spring ? shortest_spring : 1) + mass / 2 + 1;
    return {mass, first, std::max(first + 1, columns - 2 - mass / 2)};
}

std::string status(const Scene& scene, const Frame& frame, const FrameFormat& format) {
    const double step = (scene.frames.back().t - scene.frames.front().t) / static_cast<double>(scene.frames.size() - 1);
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(std::max(step, 1e-12)) - 1e-9)), 0, 9);
    const std::string t_unit = scene.t_unit.empty() ? "" : " " + scene.t_unit;
    const std::string line =
        fmt::format("{}{}t = {:.{}f}{}  θ = {:+.3g} {}  {}", scene.name, scene.name.empty() ? "" : "  ", frame.t,
                    digits, t_unit, frame.theta, scene.theta_unit, frame.stuck ? "stuck" : "");
    const std::string clean = text::displayable(line);
    std::string shown = format.charset == Charset::braille ? clean : text::in_ascii(clean);
    if (text::columns(shown) <= static_cast<std::size_t>(format.columns)) return shown;
    const std::string brief =
        fmt::format("{:.{}f} {:+.2g} {}", frame.t, digits, frame.theta, frame.stuck ? "stuck" : "");
    return std::string(text::cut_to_columns(brief, static_cast<std::size_t>(format.columns)));
}

std::string scale_line(const Scene& scene, const Places& places, int columns) {
    const Scale scale(scene.reach, false);
    const Ticks ticks = ticks_of({}, scale, std::max(1, (places.last - places.first) / 10));
    Row row(columns);
    int free = 0;
    for (std::size_t i = 0; i < ticks.at.size(); ++i) {
        const std::string& text = ticks.text[i];
        const int length = static_cast<int>(text.size());
        const int column = nearest_dot(places.middle(scene.at(ticks.at[i]))) - length / 2;
        if (column < free || column + length > columns) continue;
        row.write(column, text);
        free = column + length + 1;
    }
    return row.text();
}

}  // namespace

std::vector<std::string> text_frame(const Scene& scene, const Frame& frame, const FrameFormat& format) {
    const FrameSigns& signs = format.charset == Charset::braille ? of_unicode : of_ascii;
    const int columns = std::max(format.columns, 12);
    const Places places = places_of(scene, columns);
    const int left = nearest_dot(places.middle(scene.at(frame.theta))) - places.mass / 2;
    Row upper(columns), lower(columns), surface(columns);
    if (scene.spring) {
        upper.put(0, signs.anchor);
        lower.put(0, signs.anchor);
        for (int column = 1; column < left; ++column) lower.put(column, signs.coil[column % 2]);
    }
    if (scene.walls) {
        // The spring passes the lower wall.
        const int half = places.mass / 2 + 1;
        if (std::isfinite(scene.walls->lower)) {
            upper.put(nearest_dot(places.middle(scene.at(scene.walls->lower))) - half, signs.wall);
        }
        if (std::isfinite(scene.walls->upper)) {
            const int column = nearest_dot(places.middle(scene.at(scene.walls->upper))) + half;
            upper.put(column, signs.wall);
            lower.put(column, signs.wall);
        }
    }
    for (Row* row : {&upper, &lower}) row->fill(left, left + places.mass, frame.stuck ? signs.stuck : signs.mass);
    const int shift = nearest_dot(scene.shift(frame) * (places.last - places.first));
    for (int column = 0; column < columns; ++column) {
        surface.put(column, signs.surface[static_cast<std::size_t>(((column - shift) % 4 + 4) % 4)]);
    }
    std::vector<std::string> lines{status(scene, frame, {columns, format.charset, false}), upper.text(), lower.text(),
                                   surface.text(), scale_line(scene, places, columns)};
    if (format.colours && frame.stuck) lines[0] = "\x1b[33m" + lines[0] + "\x1b[0m";
    return lines;
}

}  // namespace dinal::plots::animation
