#include "plots/animation/scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal::plots::animation {
namespace {

/// How far the surface moves from one time to another: Simpson's rule.
double way_of(const model::Excitation& belt, double from, double to) {
    return (to - from) / 6 * (belt.value(from) + 4 * belt.value((from + to) / 2) + belt.value(to));
}

bool is_stuck(const std::vector<Interval>& stuck, double t) {
    const auto next = std::upper_bound(stuck.begin(), stuck.end(), t,
                                       [](double time, const Interval& interval) { return time < interval.low; });
    return next != stuck.begin() && t <= std::prev(next)->high;
}

Interval reach_of(const std::vector<Frame>& frames, const motion::Trajectory& run,
                  const std::optional<model::Walls>& walls) {
    Interval reach{frames.front().theta, frames.front().theta};
    const auto include = [&](double t, double theta) {
        if (t < frames.front().t || t > frames.back().t) return;
        reach = {std::min(reach.low, theta), std::max(reach.high, theta)};
    };
    for (const Frame& frame : frames) include(frame.t, frame.theta);
    // Extremes lie between frames: a computed run knows its turns, one from a file has only its rows.
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
    const std::vector<Interval> stuck = stuck_intervals(*run.trajectory);
    Frame frame;
    for (std::size_t i = 0; i <= count; ++i) {
        if (!go_on()) return text::Error{"the animation was interrupted"};
        const double t = i == count
                             ? take.to
                             : take.from + (take.to - take.from) * static_cast<double>(i) / static_cast<double>(count);
        const auto state = run.trajectory->at(t);
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
    if (run.system != nullptr) {
        scene.walls = run.system->walls();
        scene.spring = run.system->has_spring() || !run.system->spring().none();
    }
    scene.reach = reach_of(scene.frames, *run.trajectory, scene.walls);
    return scene;
}

RigScene side_by_side(std::vector<Scene> bodies, std::vector<RigScene::Link> links) {
    RigScene rig;
    std::vector<std::size_t> place(bodies.size(), bodies.size());  // where each body comes to stand
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
    constexpr double straight = 0.06;  // of the length, at each end
    std::vector<Point> corners{{0, 0}, {straight, 0}};
    for (int i = 0; i < 2 * windings; ++i) {
        corners.push_back({straight + (1 - 2 * straight) * (i + 0.5) / (2 * windings), i % 2 == 0 ? 1.0 : -1.0});
    }
    corners.push_back({1 - straight, 0});
    corners.push_back({1, 0});
    return corners;
}

}  // namespace dinal::plots::animation
