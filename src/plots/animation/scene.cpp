#include "plots/animation/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>

#include "plots/run_figure.hpp"
#include "text/characters.hpp"

namespace dinal::plots::animation {

namespace {

/// The displacement of the surface between two times, by Simpson's rule.
double way_of(const model::Excitation& belt, double from, double to) {
    return (to - from) / 6 * (belt.value(from) + 4 * belt.value((from + to) / 2) + belt.value(to));
}

bool is_stuck(const std::vector<Interval>& stuck, double t) {
    const auto next = std::ranges::upper_bound(stuck, t, {}, &Interval::low);
    return next != stuck.begin() && t <= std::prev(next)->high;
}

Interval reach_of(const std::vector<Frame>& frames, const motion::Run& run, const std::optional<model::Walls>& walls) {
    Interval reach{frames.front().theta, frames.front().theta};
    const auto include = [&](double t, double theta) {
        if (t < frames.front().t || t > frames.back().t) return;
        reach = {std::min(reach.low, theta), std::max(reach.high, theta)};
    };
    for (const Frame& frame : frames) include(frame.t, frame.theta);
    // The turns are included, because extremes may lie between frames.
    for (const model::Event& event : run.events) include(event.t, event.theta);
    const auto t = run.find("t"), theta = run.find("theta");
    for (Eigen::Index i = 0; t && theta && i < run.size(); ++i) include(run.rows(i, *t), run.rows(i, *theta));
    if (walls) {
        reach.low = std::isfinite(walls->lower) ? std::min(reach.low, walls->lower) : reach.low;
        reach.high = std::isfinite(walls->upper) ? std::max(reach.high, walls->upper) : reach.high;
    }
    const double size = std::max(std::fabs(reach.low), std::fabs(reach.high));
    if (reach.length() <= 1e-9 * size || reach.length() < shortest_axis) {  // it has never moved
        const double half = size > 10 * shortest_axis ? size / 2 : 1;
        return {reach.low - half, reach.high + half};
    }
    return reach;
}

}  // namespace

text::Expected<Track> track_of(const RunData& run, const model::Excitation* belt, const Take& take,
                               const std::function<bool()>& go_on) {
    Track track;
    const auto count = static_cast<std::size_t>(std::max(1.0, std::round(take.steps())));
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
        track.frames.push_back(frame);
    }
    track.belt = belt != nullptr;
    track.units = run.units;
    if (run.system) {
        track.walls = run.system->walls();
        track.spring = run.system->has_spring() || !run.system->spring().none();
    }
    track.reach = reach_of(track.frames, *run.result, track.walls);
    return track;
}

Scene scene_of(std::vector<Track> bodies, std::vector<Link> links, double seconds) {
    Scene scene{.bodies = {}, .links = std::move(links), .seconds = seconds};
    std::vector<std::size_t> place(bodies.size());  // the new position of each body
    Interval all = bodies.front().reach;
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const Link& link : scene.links) pairs.emplace_back(link.first, link.second);
    for (const std::size_t i : neighbours(bodies.size(), pairs)) {
        place[i] = scene.bodies.size();
        all = {std::min(all.low, bodies[i].reach.low), std::max(all.high, bodies[i].reach.high)};
        scene.bodies.push_back(std::move(bodies[i]));
    }
    for (Link& link : scene.links) link.first = place[link.first], link.second = place[link.second];
    for (Track& body : scene.bodies) body.reach = all;
    constexpr double turn = 2 * std::numbers::pi;
    scene.discs = scene.bodies.size() > 1 && all.length() > turn;
    return scene;
}

namespace {

/// The corners of a spring with these windings: fractions of its length, and of its width from -1 to 1.
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

constexpr double sheet_width = 480;  // pixels; wider for many bodies

/// The box of theta over t.
struct Graph {
    double left, right, top, bottom;
};
constexpr double hatch_width = 12;

constexpr const char* grey_ink = "#444444";
constexpr const char* stuck_colour = "#D55E00";

/// One or several bodies, each in its own cell; below, their angles over t with a moving line.
class AnimatedSvg {
public:
    explicit AnimatedSvg(const Scene& scene)
        : scene_(scene),
          clock_(scene.bodies.front()),
          alone_(scene.bodies.size() == 1),
          cell_(alone_ ? sheet_width - 2 * margin
                       : std::max(most_cell / std::sqrt(static_cast<double>(scene.bodies.size())), least_cell)),
          width_(std::max(sheet_width, cell_ * static_cast<double>(scene.bodies.size()) + 2 * margin)) {}

    std::string text() {
        begin(alone_ ? of_one_mass()
                     : fmt::format("{} bodies {}; bodies and links are orange while they stick.", scene_.bodies.size(),
                                   scene_.discs ? "as discs on one axis" : "side by side"));
        for (std::size_t i = 0; i < scene_.bodies.size() && !scene_.discs; ++i) add_floor(i);
        for (std::size_t k = 0; k < scene_.links.size(); ++k) add_link(scene_.links[k], k);
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) scene_.discs ? add_disc(i) : add_block(i);
        add_graph();
        return all_ + "</svg>\n";
    }

private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        all_ += fmt::format(format, std::forward<Arguments>(arguments)...);
    }

    void begin(const std::string& seen) {
        const std::string title = title_of(scene_);
        add("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" aria-label=\"{0}\" viewBox=\"0 0 {1} {2}\" "
            "width=\"{1}\" height=\"{2}\" font-family=\"Arial, sans-serif\" font-size=\"11\" fill=\"{3}\">\n<title>{0}</title>\n",
            title, width_, tall, grey_ink);
        const Frame &first = clock_.frames.front(), &last = clock_.frames.back();
        const std::string axes = fmt::format(" Below, θ from {:.3g} to {:.3g} over t from {:.6g} to {:.6g}.",
                                             clock_.reach.low, clock_.reach.high, first.t, last.t);
        add("<desc>{}</desc>\n<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", text::html(seen + axes), width_,
            tall);
    }

    template <class Value>
    [[nodiscard]] static std::string values(const Track& track, const Value& value) {
        std::string list;
        for (const Frame& frame : track.frames) {
            if (!list.empty()) list += ';';
            list += value(frame);
        }
        return list;
    }

    /// Adds animateTransform of this type over all frames.
    template <class Value>
    void add_motion(const char* attribute, const char* type, const Track& track, const Value& value) {
        // Viewers without animation, such as a printer, show the initial attribute.
        const std::string start = value(track.frames.front());
        all_.insert(all_.size() - 1, fmt::format(" {}=\"{}({})\"", attribute, type, start));
        add("<animateTransform attributeName=\"{}\" type=\"{}\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            attribute, type, scene_.seconds, values(track, value));
    }

    /// Changes colours only at the frames where they change.
    void add_colours(const char* attribute, const Track& track, const char* moving) {
        std::string times, inks;
        const auto count = static_cast<double>(track.frames.size() - 1);
        for (std::size_t i = 0; i < track.frames.size(); ++i) {
            const bool stuck = track.frames[i].stuck;
            if (i > 0 && stuck == track.frames[i - 1].stuck) continue;
            times += fmt::format("{}{:.5g}", i == 0 ? "" : ";", static_cast<double>(i) / count);
            inks += fmt::format("{}{}", i == 0 ? "" : ";", stuck ? stuck_colour : moving);
        }
        add("<animate attributeName=\"{}\" calcMode=\"discrete\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" keyTimes=\"{}\" "
            "values=\"{}\"/>",
            attribute, scene_.seconds, times, inks);
    }

    void words(double at_x, double at_y, const char* anchor, const std::string& text, const char* colour = grey_ink) {
        add("<text x=\"{}\" y=\"{}\" text-anchor=\"{}\" fill=\"{}\">{}</text>\n", at_x, at_y, anchor, colour,
            text::html(text::displayable(text)));
    }

    /// A polyline redrawn in each frame: scaling would distort its strokes.
    template <class Points>
    void add_line(const std::string& style, const Track& track, const Points& points) {
        add("<polyline fill=\"none\" {} points=\"{}\">", style, points(track.frames.front()));
        add("<animate attributeName=\"points\" dur=\"{:.3f}s\" repeatCount=\"indefinite\" values=\"{}\"/>",
            scene_.seconds, values(track, points));
    }
    /// The corners of a spring between two places, at this height.
    [[nodiscard]] static std::string spring_points(double from, double to, double height, double half) {
        std::string list;
        for (const Point& corner : spring_corners(9)) {
            fmt::format_to(std::back_inserter(list), "{:.1f},{:.0f} ", from + (to - from) * corner.x,
                           height + half * corner.y);
        }
        list.pop_back();
        return list;
    }

    double graph_x(const Graph& graph, std::size_t frame) const {
        return graph.left +
               (graph.right - graph.left) * static_cast<double>(frame) / static_cast<double>(clock_.frames.size() - 1);
    }
    [[nodiscard]] static double graph_y(const Graph& graph, const Track& track, double theta) {
        return graph.bottom - track.at(theta) * (graph.bottom - graph.top);
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
              clock_.units.t.empty() ? "t" : fmt::format("t, {}", clock_.units.t));
        words(graph.left + 4, graph.top - 8, "start", fmt::format("θ, {}", clock_.units.theta));
    }

    void add_curve(const Graph& graph, const Track& track, const char* colour) {
        std::string path;
        for (std::size_t i = 0; i < track.frames.size(); ++i) {
            path += fmt::format("{}{:.1f},{:.1f}", i == 0 ? "M" : " L", graph_x(graph, i),
                                graph_y(graph, track, track.frames[i].theta));
        }
        add("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"/>\n", path, colour);
    }

    static constexpr double margin = 20, tall = 330, least_cell = 76, most_cell = 240;
    static constexpr double block = 36, post = 6, top = 74, floor = 106, middle = 86, radius = 30;
    static constexpr const char* colours[] = {"#0072B2", "#009E73", "#CC79A7", "#56B4E9", "#E69F00", "#000000"};

    std::string of_one_mass() const {
        return fmt::format("A mass on {}{}{}: it starts at θ = {:.3g}, ends at {:.3g} and is orange while it sticks.",
                           clock_.belt ? "a moving belt" : "a surface with dry friction",
                           clock_.spring ? ", with a spring" : "", clock_.walls ? ", between walls" : "",
                           clock_.frames.front().theta, clock_.frames.back().theta);
    }

    const char* colour(std::size_t i) const { return colours[i % std::size(colours)]; }
    double centre(std::size_t i) const {
        const double all = cell_ * static_cast<double>(scene_.bodies.size());
        return (width_ - all) / 2 + cell_ * (static_cast<double>(i) + 0.5);
    }
    /// The travel of a block, with room for the spring on the left.
    double travel() const { return std::max(cell_ - block - 44, 8.0); }
    double shift(double theta) const {
        const Interval& reach = scene_.bodies.front().reach;
        return (theta - (reach.low + reach.high) / 2) / reach.length() * travel();
    }
    double x_of(std::size_t i, double theta) const { return centre(i) + 12 + shift(theta); }
    double x(std::size_t i, const Frame& frame) const { return scene_.discs ? centre(i) : x_of(i, frame.theta); }

    void add_floor(std::size_t i) {
        const Track& body = scene_.bodies[i];
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
                floor - 12, post, grey_ink);  // low enough that the spring passes above it
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
        add_motion("transform", "translate", scene_.bodies[i],
                   [&](const Frame& f) { return fmt::format("{:.1f}", x(i, f)); });
        add_colours("fill", scene_.bodies[i], colour(i));
        all_ += "</rect>\n";
        words(centre(i), floor + 24, "middle", scene_.bodies[i].name, colour(i));
    }

    /// A disc with a rotating mark.
    void add_disc(std::size_t i) {
        add("<circle cx=\"{:.1f}\" cy=\"{}\" r=\"{}\" fill=\"{}\">", centre(i), middle, radius, colour(i));
        add_colours("fill", scene_.bodies[i], colour(i));
        all_ += "</circle>\n";
        const double at = centre(i);
        add("<path d=\"M{:.1f},{} V{}\" stroke=\"#ffffff\" stroke-width=\"4\">", at, middle, middle + 3 - radius);
        add_motion("transform", "rotate", scene_.bodies[i], [at](const Frame& f) {
            return fmt::format("{:.1f},{:.1f},{}", f.theta * 180 / std::numbers::pi, at, middle);
        });
        all_ += "</path>\n";
        words(centre(i), middle + radius + 16, "middle", scene_.bodies[i].name, colour(i));
    }

    /// A link: straight between neighbours, otherwise above the bodies between.
    void add_link(const Link& link, std::size_t k) {
        const std::size_t left = std::min(link.first, link.second), right = std::max(link.first, link.second);
        const Track &a = scene_.bodies[left], &b = scene_.bodies[right];
        const double half = scene_.discs ? radius : block / 2;
        const double above = 12 + 9 * static_cast<double>(k % 5);
        const bool direct = right == left + 1 && first_between(left, k);
        const auto points = [&](const Frame& frame) {
            const auto at = static_cast<std::size_t>(&frame - link.track.frames.data());
            const double from = x(left, a.frames[at]), to = x(right, b.frames[at]);
            if (direct && link.track.spring) return spring_points(from + half, to - half, middle, 6);
            if (direct) return fmt::format("{:.1f},{} {:.1f},{}", from + half, middle, to - half, middle);
            return fmt::format("{0:.1f},{1} {0:.1f},{2} {3:.1f},{2} {3:.1f},{1}", from, top, above, to);
        };
        add_line(fmt::format("stroke=\"{}\" stroke-width=\"{}\"", grey_ink, link.track.spring ? 1.2 : 3), link.track,
                 points);
        add_colours("stroke", link.track, grey_ink);
        all_ += "</polyline>\n";
        direct ? words((centre(left) + centre(right)) / 2, middle - 14, "middle", link.track.name)
               : words((centre(left) + centre(right)) / 2, above - 2, "middle", link.track.name);
    }
    /// Returns whether no earlier link connects the same bodies, as it would hide this one.
    bool first_between(std::size_t left, std::size_t k) const {
        return std::none_of(
            scene_.links.begin(), scene_.links.begin() + static_cast<std::ptrdiff_t>(k), [left](const Link& other) {
                return std::min(other.first, other.second) == left && std::max(other.first, other.second) == left + 1;
            });
    }

    void add_graph() {
        const Graph graph{40, width_ - 16, 160, 306};
        add_axes(graph);
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) add_curve(graph, scene_.bodies[i], colour(i));
        add("<path d=\"M0,{} V{}\" stroke=\"{}\" stroke-width=\"1.2\">", graph.top - 4, graph.bottom + 4, stuck_colour);
        add_motion("transform", "translate", clock_, [&](const Frame& f) {
            return fmt::format("{:.1f}", graph_x(graph, static_cast<std::size_t>(&f - clock_.frames.data())));
        });
        all_ += "</path>\n";
    }

    const Scene& scene_;
    const Track& clock_;
    std::string all_;
    const bool alone_;
    const double cell_, width_;
};

}  // namespace

std::string title_of(const Scene& scene) {
    const std::vector<Frame>& frames = scene.bodies.front().frames;
    return fmt::format("A run in motion, t = {:.6g} to {:.6g}", frames.front().t, frames.back().t);
}

std::string animated_svg(const Scene& scene) {
    return AnimatedSvg(scene).text();
}

}  // namespace dinal::plots::animation
