#include "motion/stillness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "model/excitation.hpp"
#include "model/sticking.hpp"

namespace dinal::motion {

namespace {

constexpr std::size_t no_stop = static_cast<std::size_t>(-1);

/// The index of the last stop, which only user events, relays or walls may follow; otherwise no_stop.
std::size_t last_stop(const Growing<model::Event>& events) {
    for (std::size_t i = events.size(); i > 0; --i) {
        const model::EventKind kind = events[i - 1].kind;
        if (kind <= model::EventKind::rest) return model::is_stop(kind) ? i - 1 : no_stop;
    }
    return no_stop;
}

/// Returns whether something except M may move the mass.
bool moved_by_others(const model::Drive& drive) {
    const auto acts = [](const model::WantedEvent& event) { return event.act != nullptr; };
    return !drive.belt().components().empty() || std::ranges::any_of(drive.events, acts);
}

/// Returns whether M keeps the mass stuck at the very end; M may have jumped after the integrator's last decision.
bool stays(const Run& run, const model::Lowered& system, const std::optional<model::Walls>& walls, double M) {
    const double theta = run.state_at_stop.theta;
    const model::Motion way = model::motion_from_standstill(system, M, theta);
    const bool leans = walls && ((way == model::Motion::backward && theta <= walls->lower) ||
                                 (way == model::Motion::forward && theta >= walls->upper));
    return way == model::Motion::stuck || leans;
}

bool for_good(const Run& run, const model::Oscillator& oscillator, const model::Drive& drive, double since) {
    const model::Lowered system(oscillator);
    const bool creeps = run.motion_at_stop != model::Motion::stuck;
    std::optional<model::Excitation> with_base;
    if (!drive.base.components().empty()) with_base = drive.M() + drive.base.scaled(-oscillator.inertia());
    const model::Excitation& loads = with_base ? *with_base : drive.M();
    if (const double constant = loads.constant_from(); constant <= run.t_stop) {
        return creeps ? constant < run.t_stop : stays(run, system, oscillator.walls(), loads.value(run.t_stop));
    }
    if (creeps) return false;  // any change of M moves a creeping mass
    if (model::cannot_break_away(system, loads.most(), run.state_at_stop.theta)) return true;
    const double period = loads.has_feedback() ? 0 : model::period_from(loads, since);
    return period > 0 && run.t_stop - since >= period;
}

}  // namespace

void settle(Run& run, const model::Oscillator& system, const model::Drive& drive) {
    if (run.outcome != model::Outcome::stuck_at_end || moved_by_others(drive)) return;
    const std::size_t stop = last_stop(run.events);
    const double since = stop == no_stop ? run.t_start : run.events[stop].t;
    if (!for_good(run, system, drive, since)) return;
    run.outcome = model::Outcome::at_rest;
    if (stop == no_stop) return;
    const auto events = run.events.column(0);
    if (run.events.own_bytes() > 0) {  // not shared with others
        run.events.writable_values()[stop].kind = model::EventKind::rest;
        return;
    }
    std::vector<model::Event> last(events.begin() + static_cast<std::ptrdiff_t>(stop), events.end());
    last.front().kind = model::EventKind::rest;
    run.events =
        run.events.followed_by(stop, Growing<model::Event>(std::move(last)), std::numeric_limits<std::size_t>::max());
}

std::vector<model::Event> turns_on_belt(const Run& run) {
    constexpr std::size_t most_looks = 100'000;
    std::vector<double> times = {run.t_start, run.t_stop};
    for (const model::Event& event : run.events) times.push_back(event.t);
    const std::size_t stride = static_cast<std::size_t>(run.size()) / most_looks + 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(run.size()); i += stride) {
        times.push_back(run.rows(static_cast<Eigen::Index>(i), 0));
    }
    std::ranges::sort(times);
    constexpr double parts = 8, halvings = 50;
    std::vector<model::Event> turns;
    if (!run.course) return turns;
    // No run lasts 1e9 natural periods: the inertia is arbitrary where the motion is prescribed, and so is its period.
    const double natural = run.course->system().natural_period();
    const double longest = natural > 1e-9 * (run.t_stop - run.t_start) ? natural : model::never;
    double moved_at = run.t_start, velocity = run.initial.velocity;  // last time at which it was seen moving
    const auto look = [&](double to) {
        const auto now = run.at(to);
        if (!now || now->velocity == 0) return;
        if (now->velocity * velocity < 0) {
            model::State y = *now;
            double turn = to;
            for (int i = 0; i < halvings; ++i) {
                const double middle = moved_at + (turn - moved_at) / 2;
                const model::State there = run.at(middle).value();
                if (there.velocity * velocity > 0) {
                    moved_at = middle;
                } else {
                    turn = middle, y = there;
                }
            }
            turns.push_back({.t = turn, .theta = y.theta, .velocity = y.velocity});
        }
        moved_at = to, velocity = now->velocity;
    };
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        constexpr double most = 1e4;  // natural periods between two rows or events that are searched closely
        const double width = times[i + 1] - times[i];
        const double steps = parts * std::ceil(std::clamp(width / longest, 1.0, most));
        const auto count = width > 0 ? static_cast<std::size_t>(steps) : 0;
        for (std::size_t k = 1; k < count; ++k) look(times[i] + static_cast<double>(k) * width / steps);
        look(times[i + 1]);
    }
    return turns;
}

bool stands_at_stop(const Run& run) {
    if (run.state_at_stop.velocity == 0) return true;
    const auto t = run.find("t"), theta = run.find("theta"), velocity = run.find("velocity");
    const Eigen::Index last = run.size() - 1;
    if (!t || !theta || !velocity || last < 1) return false;
    const double dt = run.rows(last, *t) - run.rows(last - 1, *t), place = run.rows(last, *theta);
    const double moved =
        std::max({std::fabs(place - run.rows(last - 1, *theta)), std::fabs(run.rows(last, *velocity)) * dt,
                  std::fabs(run.rows(last - 1, *velocity)) * dt});
    return moved <= 64 * std::numeric_limits<double>::epsilon() * std::fabs(place);
}

double peak(const Run& run) {
    double greatest = std::max(std::fabs(run.initial.theta), std::fabs(run.state_at_stop.theta));
    if (const auto theta = run.find("theta"); theta && run.size() > 0) {
        greatest = std::max(greatest, run.rows.col(*theta).cwiseAbs().maxCoeff());
    }
    for (const model::Event& event : run.events) {
        greatest = std::max(greatest, std::fabs(event.theta));
        if (event.kind != model::EventKind::user || !run.course) continue;
        // an action may have moved it
        if (const auto y = run.at(event.t)) greatest = std::max(greatest, std::fabs(y->theta));
    }
    if (run.on_belt) {
        for (const model::Event& turn : turns_on_belt(run)) greatest = std::max(greatest, std::fabs(turn.theta));
    }
    return greatest;
}

}  // namespace dinal::motion
