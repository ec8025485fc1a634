#include "analysis/stretches.hpp"

#include <algorithm>

namespace dinal::analysis {

namespace {

/// A run that begins with a slip, or in which nothing ever happens and that ends at rest or broke off stuck, was stuck
/// from its start.
bool begins_stuck(const motion::Trajectory& trajectory) {
    if (trajectory.initial.velocity != 0) return false;
    if (!trajectory.events.empty()) return trajectory.events.front().kind == model::EventKind::slip;
    if (trajectory.outcome == model::Outcome::reached_end) return false;
    return trajectory.outcome == model::Outcome::at_rest || trajectory.motion_at_stop == model::Motion::stuck;
}

}  // namespace

std::vector<Stretch> stretches(const motion::Trajectory& trajectory) {
    std::vector<Stretch> list;
    list.reserve(trajectory.events.size() + 1);
    Stretch now{.from = trajectory.t_start, .begin = trajectory.initial, .stuck = begins_stuck(trajectory)};
    for (const model::Event& event : trajectory.events) {
        now.to = event.t;
        now.end = {event.theta, 0};
        now.ended_by = event;
        list.push_back(now);
        now = {.from = event.t, .begin = now.end, .begun_by = event};
        now.stuck = event.kind == model::EventKind::stick || event.kind == model::EventKind::rest;
    }
    now.to = std::max(trajectory.t_stop, now.from);
    now.end = now.stuck ? now.begin : trajectory.state_at_stop;
    list.push_back(now);
    return list;
}

}  // namespace dinal::analysis
