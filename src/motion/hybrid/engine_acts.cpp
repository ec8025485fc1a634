// Events of the user in a run with more in it: where they are, and what he does then.
#include <algorithm>
#include <cmath>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

namespace {

constexpr std::size_t most_passages = 200;
/// Passages of user events that are so near to each other on a piece, of which the half is 1, are one instant.
constexpr double one_instant = 64 * rounding;
/// One that is so near to a standstill, or to a release, is told after it.
constexpr double beside_standstill = 1e-12;
/// A value that is this part of what it was on the piece stands at zero.
constexpr double at_zero = 1e-12;

}  // namespace

/// Events of the user, if one of them comes before the end that is known so far.
void Engine::watch_users(Ending& ending) {
    Nodes values{};
    const double before = ending.x - (ending.by == By::surface ? beside_standstill : 0);
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
        const Watched watched(values, exact, watches_[i].rounded);
        double from = -1;
        Half half = watches_[i].half;
        while (const auto x = watched.leaves(half, from)) {
            if (!(*x < before)) break;
            if (watches_[i].sent_back && !watched.is_clearly(half, *x)) return come_again(i);
            if (wanted.direction == model::Crossing::both || (half < 0) == (wanted.direction == model::Crossing::up)) {
                wanted_ones.emplace_back(i, *x);
                break;
            }
            if (unwanted.size() > most_passages) break;
            if (watches_[i].half == 0) watches_[i].half = half;
            unwanted.emplace_back(i, *x);
            half = -half;
            from = *x;
        }
        if (watches_[i].half == 0) watches_[i].half = half;
        if (watches_[i].sent_back) watches_[i].sent_back = !watched.is_clearly(watches_[i].half, 1);
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
        if (x <= ending.x) watches_[event].half = -watches_[event].half;
    }
}

/// What an act threw back, or stopped, is through zero without having been beyond rounding on the side that it came
/// from: it would be thrown back again at once, and again.
void Engine::come_again(std::size_t event) {
    const bool told = !events_.empty() && events_.back().kind == model::EventKind::user && events_.back().t == now_.hi;
    if (!told) tell(model::EventKind::user, static_cast<int>(event));
    fail(model::Outcome::chattering);
}

bool Engine::act_all(const std::vector<std::size_t>& told) {
    came_from_.clear();
    for (const Watch& watch : watches_) came_from_.push_back(watch.half);
    for (const std::size_t which : told) watches_[which].half = -watches_[which].half;
    if (!std::all_of(told.begin(), told.end(), [&](std::size_t which) { return act(which, told); })) return false;
    // What comes at the same instant is told before one of them stops the run: it would not be told when that goes on.
    const bool stops =
        std::any_of(told.begin(), told.end(), [&](std::size_t which) { return extras_.events[which].stop; });
    return !stops || fail(model::Outcome::stopped);
}

bool Engine::act(std::size_t which, const std::vector<std::size_t>& told) {
    const model::WantedEvent& wanted = extras_.events[which];
    tell(model::EventKind::user, static_cast<int>(which));
    if (wanted.act != nullptr) {
        const std::vector<double> before = watched_values(2);
        const Values states(y_.begin() + 2, y_.end());
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
        const bool changed = moved || !std::equal(states.begin(), states.end(), y_.begin() + 2);
        stand_where_put(before, changed ? told : std::vector<std::size_t>());
        echo(now_.hi, 1);
        if (moved) throw_from_here();
        if (moved && watches_[which].fading.after(now_.hi) && !wanted.stop) return fail(model::Outcome::chattering);
    }
    return wanted.stop || !too_often() || fail(model::Outcome::chattering);
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

/// A mass that was thrown, and is soon back, is to be seen on its way.
void Engine::throw_from_here() {
    const double a = standstill_.stuck() ? 0 : acceleration();
    const bool short_flight = y_[1] * a < 0 && std::fabs(y_[1]) < std::fabs(a) * cut_.longest;
    flight_ = {theta(), !short_flight ? 0 : y_[1] > 0 ? -1 : 1};
}

/// How far a watched value goes when what it is made of changes by some ulps.
double Engine::rounding_of(std::size_t event) const {
    constexpr double ulps = 1 + 4 * rounding;
    const MotionPoint at = here();
    const auto value = [&](double theta, double velocity) {
        return extras_.events[event].when->value_with(at.t, {theta, velocity}, at.states);
    };
    const double own = value(at.y.theta, at.y.velocity);
    return std::max(std::fabs(value(at.y.theta * ulps, at.y.velocity) - own),
                    std::fabs(value(at.y.theta, at.y.velocity * ulps) - own));
}

/// Whether a value at zero goes on to the side to which it has come, now that the user has acted, as it does at once;
/// else he threw it back, or stopped it.
bool Engine::passes_on(std::size_t event) const {
    constexpr double soon = 1e-4;
    const double step = soon * h_, a = standstill_.stuck() ? 0 : acceleration();
    Values rates(y_.size()), states(y_.size() - 2);
    field_.rates(here(), rates.data() + 2);
    const auto value = [&](double after) {
        for (std::size_t k = 2; k < y_.size(); ++k) states[k - 2] = y_[k] + after * rates[k];
        return extras_.events[event].when->value_with(now_.hi + after, {theta() + after * y_[1], y_[1] + after * a},
                                                      states);
    };
    return came_from_[event] * (value(step) - value(-step)) < -watches_[event].rounded;
}

/// What the user did may have put watched values on the other side of zero, which is no passing. A value that was told
/// stands at zero still when he changed something else, as a bounce does: its half is the one that it came from, or,
/// when it goes on, what it comes to next.
void Engine::stand_where_put(const std::vector<double>& before, const std::vector<std::size_t>& told) {
    const std::vector<double> now = watched_values(2), begin = watched_values(-1), end = watched_values(1);
    for (std::size_t i = 0; i < watches_.size(); ++i) {
        const double size = std::max({std::fabs(begin[i]), std::fabs(end[i]), std::fabs(now[i])});
        if (now[i] == before[i]) {
            // One that an impact took past zero does not stand there.
            const bool stands = std::fabs(now[i]) <= at_zero * size + 2 * rounding_of(i) + watches_[i].rounded;
            if (!stands || std::find(told.begin(), told.end(), i) == told.end()) continue;
            watches_[i].rounded = 2 * std::fabs(now[i]) + rounding_of(i);
            watches_[i].sent_back = !passes_on(i);
            watches_[i].half = watches_[i].sent_back ? came_from_[i] : 0;
            continue;
        }
        watches_[i].half = std::fabs(now[i]) <= at_zero * size ? 0 : now[i] > 0 ? 1 : -1;
        watches_[i].sent_back = false;
    }
}

}  // namespace dinal::motion::hybrid
