// What ends a piece of a run with more in it: the surface, a relay, an event of the user; and what happens then.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

namespace {

/// Events that follow each other within this time, in units of the pace, so often, go on for ever.
constexpr double at_once = 1e-9;
constexpr std::size_t most_passages = 200;
/// Passages of user events that are so near to each other on a piece, of which the half is 1, are one instant.
constexpr double one_instant = 64 * rounding;
/// A value that is this part of what it was on the piece stands at zero.
constexpr double at_zero = 1e-12;

}  // namespace

MotionPoint Engine::point(double x) const {
    point_states_.resize(y_.size() - 2);
    for (std::size_t k = 2; k < y_.size(); ++k) point_states_[k - 2] = piece_.at(k, x);
    const Side side = x <= -1 ? piece_.side(0) : x >= 1 ? piece_.side(node_count - 1) : Side::at;
    return {x >= 1 ? piece_.end : piece_.time(x), side, {piece_.theta(x), piece_.at(1, x)}, point_states_};
}

MotionPoint Engine::point_at(std::size_t node) const {
    point_states_.resize(y_.size() - 2);
    for (std::size_t k = 2; k < y_.size(); ++k) point_states_[k - 2] = piece_.y[k][node];
    return {piece_.times[node], piece_.side(node), {piece_.theta_at(node), piece_.y[1][node]}, point_states_};
}

/// Relays and events of the user, if one of them comes before the end that is known so far.
void Engine::watch(Ending& ending) {
    Nodes values{};
    for (std::size_t i = 0; i < field_.component_count(); ++i) {
        if (field_.relay(i) == nullptr) continue;
        const auto exact = [&](double x) { return field_.until_switch(i, point(x)); };
        for (std::size_t j = 0; j < node_count; ++j) values[j] = field_.until_switch(i, point_at(j));
        Half half = 1;
        const auto x = values[0] < 0 ? std::optional(-1.0) : Watched(values, exact).leaves(half, -1);
        if (x && *x < ending.x) ending = {*x, By::relay, i};
    }
    std::vector<std::pair<std::size_t, double>> wanted_ones, unwanted;  // passages; the others only change the half
    for (std::size_t i = 0; i < extras_.events.size(); ++i) {
        const model::WantedEvent& wanted = extras_.events[i];
        const auto at = [&](const MotionPoint& p) { return wanted.when->value_with(p.t, p.y, p.states); };
        const auto exact = [&](double x) { return at(point(x)); };
        for (std::size_t j = 0; j < node_count; ++j) {
            values[j] = at(point_at(j));
            if (!std::isfinite(values[j])) {
                fail(model::Outcome::excitation_not_finite);
                return;
            }
        }
        const Watched watched(values, exact);
        double from = -1;
        Half half = halves_[i];
        while (const auto x = watched.leaves(half, from)) {
            if (!(*x < ending.x)) break;
            if (wanted.direction == model::Crossing::both || (half < 0) == (wanted.direction == model::Crossing::up)) {
                wanted_ones.emplace_back(i, *x);
                break;
            }
            if (unwanted.size() > most_passages) break;
            if (halves_[i] == 0) halves_[i] = half;
            unwanted.emplace_back(i, *x);
            half = -half;
            from = *x;
        }
        if (halves_[i] == 0) halves_[i] = half;
    }
    if (!wanted_ones.empty()) {
        double first = 1;
        for (const auto& [event, x] : wanted_ones) first = std::min(first, x);
        ending = {first, By::user};
        for (const auto& [event, x] : wanted_ones) {
            if (x <= first + one_instant) ending.users.push_back(event);
        }
    }
    for (const auto& [event, x] : unwanted) {
        if (x <= ending.x) halves_[event] = -halves_[event];
    }
}

bool Engine::handle(const Ending& ending) {
    switch (ending.by) {
        case By::nobody:
            return true;
        case By::surface:
            if (ending.towards != model::Motion::stuck) return release(ending.towards);
            standstill_.lean(model::Motion::stuck);
            y_[1] = belt();
            if (!creep()) standstill_.arrive();
            return true;
        case By::wall:
            return hit(ending.towards);
        case By::relay:
            field_.toggle(ending.which);
            tell(model::EventKind::switched);
            return !too_often() || fail(model::Outcome::chattering);
        case By::user:
            for (const std::size_t which : ending.users) halves_[which] = -halves_[which];
            return std::all_of(ending.users.begin(), ending.users.end(),
                               [&](std::size_t which) { return act(which, ending.users); });
    }
    return true;
}

bool Engine::act(std::size_t which, const std::vector<std::size_t>& fired) {
    const model::WantedEvent& wanted = extras_.events[which];
    tell(model::EventKind::user, static_cast<int>(which));
    if (wanted.act != nullptr) {
        const std::vector<double> before = watched_values(2);
        model::State state{theta(), y_[1]};
        if (!wanted.act->act(now_.hi, state, {y_.data() + 2, y_.size() - 2})) {
            return fail(model::Outcome::excitation_not_finite);
        }
        if (const auto& walls = problem_.system.walls()) {
            state.theta = std::clamp(state.theta, walls->lower, walls->upper);
        }
        const auto energy = [&](double theta, double velocity) {
            return (system_.inertia() * velocity * velocity + system_.stiffness() * theta * theta) / 2 +
                   problem_.system.spring().energy(theta);
        };
        if (problem_.limits.dense) {
            pieces_->add_jump(now_.hi, {.acts = energy(state.theta, state.velocity) - energy(theta(), y_[1])});
        }
        const bool moved = state.theta != theta() || state.velocity != y_[1];
        if (moved) {
            set_theta(state.theta);
            y_[1] = state.velocity;
            standstill_.lean(model::Motion::stuck);
        }
        const double slip = y_[1] - belt();
        if (moved && !standstill_.passes()) {
            standstill_.return_to({slip == 0 ? model::Motion::stuck : model::motion_of(slip),
                                   slip == 0 ? Standstill::Phase::arrived : Standstill::Phase::moving});
        } else if (moved) {
            standstill_.thrown(model::motion_of(slip));
        }
        if (moved) touch_wall(false);
        stand_where_put(before, fired);
        echo(now_.hi, 1);
    }
    if (wanted.stop) return fail(model::Outcome::stopped);
    return !too_often() || fail(model::Outcome::chattering);
}

/// What all events of the user watch, at x of the piece; beyond it, now.
std::vector<double> Engine::watched_values(double x) const {
    const MotionPoint at = x > 1 ? here() : point(x);
    std::vector<double> values;
    values.reserve(extras_.events.size());
    for (const model::WantedEvent& event : extras_.events)
        values.push_back(event.when->value_with(at.t, at.y, at.states));
    return values;
}

/// What the user did may have put watched values on the other side of zero, which is no passing; and what has come to
/// zero, and was told, may be sent back to where it came from, which is none either.
void Engine::stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& fired) {
    const std::vector<double> now = watched_values(2), begin = watched_values(-1), end = watched_values(1);
    for (std::size_t i = 0; i < halves_.size(); ++i) {
        const bool told = std::find(fired.begin(), fired.end(), i) != fired.end();
        if (now[i] == before[i] && !told) continue;
        const double size = std::max({std::fabs(begin[i]), std::fabs(end[i]), std::fabs(now[i])});
        halves_[i] = std::fabs(now[i]) <= at_zero * size ? 0 : now[i] > 0 ? 1 : -1;
    }
}

/// A surface that changes its velocity at once leaves the mass behind, or turns the sliding round.
bool Engine::belt_jumps(double before) {
    const double slip = y_[1] - belt();
    if (!std::isfinite(slip)) return fail(model::Outcome::excitation_not_finite);
    // Where it only turns a corner its values differ by rounding, and by what it does in a hair of time.
    const double rate = std::max(std::fabs(piece_.belt_rate[node_count - 1]), std::fabs(field_.belt_rate(now_.hi)));
    const double corner = 64 * rounding * (std::fabs(belt()) + std::fabs(before) + rate * std::fabs(now_.hi));
    if (std::fabs(belt() - before) <= corner || standstill_.passes() || leans()) return true;
    if (slip == 0) {
        standstill_.arrive();
        return true;
    }
    const model::Motion motion = model::motion_of(slip);
    if (standstill_.stuck()) {
        if (!release(motion)) return false;
    } else if (motion != standstill_.motion()) {
        tell(model::EventKind::turn);
    }
    standstill_.return_to({motion, Standstill::Phase::moving});
    return true;
}

void Engine::tell(model::EventKind kind, int user) {
    const double M = field_.load(here());
    events_.push_back({now_.hi, kind, theta(), M, user, y_[1]});
}

bool Engine::too_often() {
    return storm_.after(now_.hi, at_once * pace_);
}

bool Engine::ask() {
    y_[1] = carrier();
    const double M = field_.load(here());
    if (!std::isfinite(M + y_[1] + pull(M))) return fail(model::Outcome::excitation_not_finite);
    const std::size_t told = events_.size();
    const bool sane = standstill_.ask({now_.hi, theta(), pull(M)});
    if (events_.size() > told) events_.back().M = M, events_.back().velocity = y_[1];
    go_from_wall();
    return sane || fail(model::Outcome::chattering);
}

bool Engine::release(model::Motion towards) {
    const double M = field_.load(here());
    if (!std::isfinite(M)) return fail(model::Outcome::excitation_not_finite);
    const std::size_t told = events_.size();
    const bool sane = standstill_.release({now_.hi, theta(), pull(M)}, towards);
    if (events_.size() > told) events_.back().M = M, events_.back().velocity = y_[1];
    go_from_wall();
    return sane || fail(model::Outcome::chattering);
}

}  // namespace dinal::motion::hybrid
