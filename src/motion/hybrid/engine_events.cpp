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

/// Where the mass is as fast as its surface. At the end of the piece, zero within rounding is zero.
std::optional<double> Engine::first_standstill() const {
    using namespace spectral::chebyshev;
    Series slip = piece_.series[1];
    slip[0] += y_[1];
    if (field_.has_belt()) {
        const Series belt = fit(piece_.belt);
        for (std::size_t k = 0; k < points; ++k) slip[k] -= belt[k];
    }
    const double fastest = greatest(piece_.y[1]) + greatest(piece_.belt);
    const double torques = greatest(piece_.M) + greatest(piece_.push) + system_.greatest_holding() +
                           system_.stiffness() * (greatest(piece_.y[0]) + std::fabs(origin_)) +
                           std::fabs(system_.spring(theta()));
    Bounded<points> curve(model::sign_of(standstill_.motion()), slip, derivative(slip));
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    if (field_.has_belt()) curve.raise_floor(16 * rounding * fastest);
    curve.raise_slope_floor(piece_.h / system_.inertia() * 64 * rounding * torques);
    const auto always = [](double) { return true; };
    const auto zero = first_below(curve, -1, leaving ? LeftEnd::leaving : LeftEnd::anywhere, always);
    if (!zero && curve(1) <= curve.floor()) return 1;
    return zero;
}

/// Whether all that goes on in the piece is slower than the rounding of its torques could make it.
bool Engine::creeps() const {
    if (field_.has_belt() || leans()) return false;
    const double torques = greatest(piece_.M) + greatest(piece_.push) + system_.greatest_holding() +
                           system_.stiffness() * (greatest(piece_.y[0]) + std::fabs(origin_));
    const double hold = system_.damping() + system_.inertia() / (2 * piece_.h);
    return greatest(piece_.y[1]) * hold <= 4 * rounding * torques;
}

/// Where the pull passes the limit of sticking, and which way; 2 when nowhere.
std::pair<double, model::Motion> Engine::first_release() const {
    using namespace spectral::chebyshev;
    std::pair<double, model::Motion> first{2, model::Motion::stuck};
    const auto pull_at = [&](double M, double push, double rate, double belt) {
        if (piece_.leans) return M + push + belt_at_wall(belt);
        return M + push - system_.inertia() * rate - system_.damping() * belt;
    };
    Nodes pulls{};
    for (std::size_t j = 0; j < points; ++j) {
        pulls[j] = pull_at(piece_.M[j], piece_.push[j], piece_.belt_rate[j], piece_.belt[j]) -
                   system_.pull_back(piece_.origin + piece_.y[0][j]);
    }
    const Series pull = fit(pulls);
    const double largest = greatest(piece_.M) + greatest(piece_.push) +
                           system_.stiffness() * (greatest(piece_.y[0]) + std::fabs(origin_)) +
                           std::fabs(system_.spring(theta()));
    const bool held = standstill_.phase() == Standstill::Phase::held;
    const double at_first = pull_at(piece_.M[0], piece_.push[0], piece_.belt_rate[0], piece_.belt[0]);
    const double clearly_beyond = held ? standstill_.clearly_beyond({now_.hi, theta(), at_first}) : 0;
    const double rounded_rate = 256 * rounding * greatest(piece_.belt) / piece_.h;
    const Series belt = fit(piece_.belt), rate = fit(piece_.belt_rate);
    for (const model::Motion side : {model::Motion::forward, model::Motion::backward}) {
        if (side == standstill_.leans()) continue;
        const double sign = model::sign_of(side), limit = standstill_.limit(side);
        Series left{};
        for (std::size_t k = 0; k < points; ++k) left[k] = -sign * pull[k];
        left[0] += limit;
        if (held) left[0] += clearly_beyond;
        Bounded<points> curve(1, left, derivative(left));
        const double doubt =
            8 * (rounding * (std::fabs(limit) + largest) + tail(pull)) + system_.inertia() * rounded_rate;
        curve.raise_floor(doubt);
        const auto lets_go = [&](double x) {
            const MotionPoint at = point(x);
            const double M = field_.load(at);
            const double whole = value(rate, x),
                         sure = std::copysign(std::max(0.0, std::fabs(whole) - rounded_rate), whole);
            return standstill_.pulled(pull_at(M, field_.push(at.t, at.side), sure, value(belt, x)), at.y.theta) == side;
        };
        std::optional<double> touch;
        const auto touches = [&](double x) {
            if (held) return false;
            for (const double place : {x, curve.lowest_near(x)}) {
                if (!touch && lets_go(place)) touch = place;
            }
            return touch.has_value();
        };
        auto x = first_below(curve, -1, LeftEnd::anywhere, touches);
        // Where the two meet so gently that rounding hides it the pull itself says when.
        if (x && touch) x = first_true(lets_go, *touch);
        if (x && *x < first.first && piece_.time(*x) < piece_.end) first = {*x, side};
    }
    return first;
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
                               [this](std::size_t which) { return act(which); });
    }
    return true;
}

bool Engine::creep() {
    return !field_.has_belt() && standstill_.creep({now_.hi, theta(), pull(field_.load(here()))});
}

bool Engine::act(std::size_t which) {
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
        stand_where_put(before);
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

/// What the user did may have put watched values on the other side of zero, which is no passing.
void Engine::stand_where_put(const std::vector<double>& before) {
    const std::vector<double> now = watched_values(2), begin = watched_values(-1), end = watched_values(1);
    for (std::size_t i = 0; i < halves_.size(); ++i) {
        if (now[i] == before[i]) continue;
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

/// Without friction nothing happens at a turn, it is only told.
void Engine::record_turns(double until) {
    using namespace spectral::chebyshev;
    Series v = piece_.series[1];
    v[0] += y_[1];
    const double moving = greatest(piece_.y[1]);
    const double torques = greatest(piece_.M) + greatest(piece_.push) +
                           system_.stiffness() * (greatest(piece_.y[0]) + std::fabs(origin_)) +
                           std::fabs(system_.spring(theta()));
    if (moving <= 100 * rounding * piece_.h / system_.inertia() * torques) return;
    if (standstill_.motion() == model::Motion::stuck) {
        const std::span<const double> velocities = piece_.y[1];
        const auto first =
            std::find_if(velocities.begin(), velocities.end(), [&](double u) { return std::fabs(u) > 1e-14 * moving; });
        standstill_.head(model::motion_of(first == velocities.end() ? 0 : *first));
    }
    double from = -1;
    LeftEnd start = y_[1] == 0 ? LeftEnd::leaving : LeftEnd::anywhere;
    const auto no = [](double) { return false; };
    bool headed_back = false;
    while (standstill_.motion() != model::Motion::stuck) {
        const model::Motion motion = standstill_.motion();
        const Bounded<points> curve(model::sign_of(motion), v, derivative(v));
        const auto x = first_below(curve, from, start, no);
        if (!x || *x > until) break;
        if (start == LeftEnd::leaving && *x <= from && (from > -1 || standstill_.last_told() == now_.hi)) {
            standstill_.head(motion == model::Motion::forward ? model::Motion::backward : model::Motion::forward);
            if (from > -1 || headed_back) break;  // it gets under way neither way: all of it is rounding
            headed_back = true;
        } else {
            const MotionPoint at = point(*x);
            standstill_.turned({at.t, at.y.theta, field_.load(at)});
        }
        from = *x;
        start = LeftEnd::leaving;
    }
}

}  // namespace dinal::motion::hybrid
