#include "analysis/stretches.hpp"

#include <algorithm>

#include "motion/stillness.hpp"

namespace dinal::analysis {

std::vector<Stretch> stretches(const motion::Trajectory& trajectory) {
    std::vector<Stretch> list;
    list.reserve(trajectory.events.size() + 1);
    Stretch now{.from = trajectory.t_start, .begin = trajectory.initial, .stuck = trajectory.began_stuck};
    for (const model::Event& event : trajectory.events) {
        const bool lets_go = event.kind == model::EventKind::opened && now.stuck;
        if (event.kind > model::EventKind::impact && !lets_go) continue;
        now.to = event.t;
        now.end = {event.theta, event.velocity};
        now.ended_by = event;
        list.push_back(now);
        now = {.from = event.t, .begin = now.end, .begun_by = event};
        if (event.kind == model::EventKind::impact) now.begin.velocity *= -trajectory.restitution;
        now.stuck = model::is_stop(event.kind);
    }
    now.to = std::max(trajectory.t_stop, now.from);
    now.end = now.stuck && trajectory.carried == nullptr ? now.begin : trajectory.state_at_stop;
    list.push_back(now);
    return list;
}

double time_open(const motion::Trajectory& trajectory) {
    bool open = trajectory.began_open;
    double since = trajectory.t_start, time = 0;
    for (const model::Event& event : trajectory.events) {
        if (event.kind != model::EventKind::opened && event.kind != model::EventKind::closed) continue;
        if (open) time += event.t - since;
        open = event.kind == model::EventKind::opened, since = event.t;
    }
    return open ? time + (trajectory.t_stop - since) : time;
}

std::vector<Stretch> half_cycles(const motion::Trajectory& trajectory) {
    if (!trajectory.on_belt) return stretches(trajectory);
    motion::Trajectory swings = trajectory;
    swings.events = motion::Growing<model::Event>(motion::turns_on_belt(trajectory));
    swings.began_stuck = false;
    return stretches(swings);
}

}  // namespace dinal::analysis
