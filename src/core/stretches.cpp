#include "core/stretches.hpp"

#include <algorithm>

#include "core/panels.hpp"

namespace dinal {

namespace {

/// A run that begins with a slip, or in which nothing ever happens and that ends at rest, was stuck from its start.
bool begins_stuck(const Trajectory& trajectory) {
    if (trajectory.initial.velocity != 0) return false;
    if (!trajectory.events.empty()) return trajectory.events.front().kind == EventKind::slip;
    return trajectory.outcome == Outcome::at_rest;
}

}  // namespace

std::optional<State> last_state(const Trajectory& trajectory) {
    if (const Panels* panels = trajectory.panels.get(); panels != nullptr && panels->size() > 0) {
        if (panels->complete()) return panels->at(trajectory.t_stop);
    }
    const Eigen::Index n = trajectory.size();
    if (n > 0 && trajectory.column(Column::t)[n - 1] == trajectory.t_stop) {
        return State{trajectory.column(Column::theta)[n - 1], trajectory.column(Column::velocity)[n - 1]};
    }
    if (!trajectory.events.empty()) {
        const Event& last = trajectory.events.back();
        if (last.kind == EventKind::stick || last.kind == EventKind::rest) return State{last.theta, 0};
    }
    return {};
}

std::vector<Stretch> stretches(const Trajectory& trajectory) {
    std::vector<Stretch> list;
    list.reserve(trajectory.events.size() + 1);
    Stretch now{.from = trajectory.t_start, .begin = trajectory.initial, .stuck = begins_stuck(trajectory)};
    for (const Event& event : trajectory.events) {
        now.to = event.t;
        now.end = {event.theta, 0};
        now.ended_by = event;
        list.push_back(now);
        now = {.from = event.t, .begin = now.end, .begun_by = event};
        now.stuck = event.kind == EventKind::stick || event.kind == EventKind::rest;
    }
    now.to = std::max(trajectory.t_stop, now.from);
    now.end = now.stuck ? now.begin : last_state(trajectory).value_or(now.begin);
    list.push_back(now);
    return list;
}

}  // namespace dinal
