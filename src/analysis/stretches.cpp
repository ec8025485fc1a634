#include "analysis/stretches.hpp"

#include <algorithm>

#include "motion/stillness.hpp"

namespace dinal::analysis {

std::vector<Stretch> stretches(const motion::Run& run) {
    std::vector<Stretch> list;
    list.reserve(run.events.size() + 1);
    Stretch now{.from = run.t_start, .begin = run.initial, .stuck = run.began_stuck};
    for (const model::Event& event : run.events) {
        const bool lets_go = event.kind == model::EventKind::opened && now.stuck;
        if (event.kind > model::EventKind::impact && !lets_go) continue;
        now.to = event.t;
        now.end = {event.theta, event.velocity};
        now.ended_by = event;
        list.push_back(now);
        now = {.from = event.t, .begin = now.end, .begun_by = event};
        if (event.kind == model::EventKind::impact) now.begin.velocity *= -run.restitution;
        now.stuck = model::is_stop(event.kind);
    }
    now.to = std::max(run.t_stop, now.from);
    now.end = now.stuck && run.left == nullptr ? now.begin : run.state_at_stop;
    list.push_back(now);
    return list;
}

double time_open(const motion::Run& run) {
    bool open = run.began_open;
    double since = run.t_start, time = 0;
    for (const model::Event& event : run.events) {
        if (event.kind != model::EventKind::opened && event.kind != model::EventKind::closed) continue;
        if (open) time += event.t - since;
        open = event.kind == model::EventKind::opened, since = event.t;
    }
    return open ? time + (run.t_stop - since) : time;
}

std::vector<Stretch> half_cycles(const motion::Run& run) {
    if (!run.on_belt) return stretches(run);
    motion::Run swings = run;
    swings.events = motion::Growing<model::Event>(motion::turns_on_belt(run));
    swings.began_stuck = false;
    return stretches(swings);
}

}  // namespace dinal::analysis
