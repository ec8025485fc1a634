// What ends a piece of a run with more in it: the surface, a relay; and what happens then. Events of the user are in
// engine_acts.cpp.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "motion/hybrid/engine.hpp"
#include "motion/spectral/break_search.hpp"

namespace dinal::motion::hybrid {

namespace {

/// Events that follow each other within this time, in units of the pace, so often, go on for ever.
constexpr double at_once = 1e-9;
/// How often a delay brings back a kink before it is too smooth to be seen.
constexpr int most_echoes = 8;

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
    for (std::size_t i = 0; i < field_.component_count(); ++i) {
        if (field_.relay(i) == nullptr) continue;
        const auto place = field_.looks_at(i);
        const auto x = place ? first_switch(i, *place, ending.x) : first_switch(i);
        if (x && *x < ending.x) ending = {*x, By::relay, i};
    }
    watch_users(ending);
}

/// Of a relay that looks at a function.
std::optional<double> Engine::first_switch(std::size_t relay) const {
    Nodes values{};
    const auto exact = [&](double x) { return field_.until_switch(relay, point(x)); };
    for (std::size_t j = 0; j < node_count; ++j) values[j] = field_.until_switch(relay, point_at(j));
    Half half = 1;
    return values[0] < 0 ? std::optional(-1.0) : Watched(values, exact).leaves(half, -1);
}

/// Of one that looks at theta, the velocity or a state: its series tells. Beyond `until` nobody asks.
std::optional<double> Engine::first_switch(std::size_t relay, std::size_t place, double until) const {
    using namespace spectral::chebyshev;
    const auto [sign, level] = field_.threshold(relay);
    const auto left = [&, s = sign, l = level](double y) { return s * ((place == 0 ? piece_.origin + y : y) - l); };
    const double first = left(piece_.y[place][0]);
    if (first < 0) return -1;
    Series series = piece_.series[place];
    for (double& c : series) c *= sign;
    series[0] += first;
    if (stays_above_zero(1, series)) return {};
    const double all = cheb::size(series);
    const bool touches = first <= 64 * rounding * all;
    // Between two standstills theta goes one way.
    if (place == 0 && !touches && !standstill_.passes() && !field_.has_belt() && cut_.h == 0) {
        const double last = left(piece_.at(0, until));
        if (!(last < -16 * rounding * all)) return {};
        const auto beyond = [&](double x) { return -value(series, x); };
        return first_positive(beyond, -1, -first, until, -last, 1e-16).second;
    }
    const auto no = [](double) { return false; };
    const Bounded<points> curve(1, series, derivative(series));
    return first_below(curve, -1, touches ? LeftEnd::leaving : LeftEnd::anywhere, no);
}

bool Engine::handle(const Ending& ending) {
    switch (ending.by) {
        case By::nobody:
        case By::corner:
            return true;
        case By::surface:
            if (ending.towards != model::Motion::stuck) return release(ending.towards);
            standstill_.lean(model::Motion::stuck);
            y_[1] = belt();
            touch();
            if (!creep()) standstill_.arrive();
            return true;
        case By::wall:
            return hit(ending.towards);
        case By::relay:
            field_.toggle(ending.which);
            tell(model::EventKind::switched);
            return !too_often() || fail(model::Outcome::chattering);
        case By::user:
            return act_all(ending.users);
    }
    return true;
}

/// What is nearer than that differs by rounding, or at t = 0 by less than any motion can tell.
double Engine::least_time() const {
    constexpr double nothing = 1e-25, few = 16;
    return std::max(few * rounding * std::fabs(now_.hi), nothing * pace_);
}

/// Whether a jump of the belt is so near that no piece fits before it.
bool Engine::before_jump() const {
    return belt_jump_ - now_.hi <= least_time();
}

/// Right before a jump the slope of the belt is none: whether that is what would let a stuck mass go.
bool Engine::find_jump_here() {
    if (!field_.has_belt()) return false;
    const auto belt = [&](double t) { return field_.belt(t, Side::at); };
    const double ahead = now_.hi + least_time(), here = belt(now_.hi), there = belt(ahead);
    constexpr double clearly = 1e-6;
    if (!(std::fabs(there - here) > clearly * std::max(solver_.fastest_belt(), std::fabs(there)))) return false;
    belt_jump_ = std::min(belt_jump_, spectral::jump_between(now_.hi, here, ahead, there, belt));
    return true;
}

/// A surface that changes its velocity at once leaves the mass behind, or turns the sliding round.
bool Engine::belt_jumps(double before) {
    const double slip = y_[1] - belt();
    if (!std::isfinite(slip)) return fail(model::Outcome::excitation_not_finite);
    // Where it only turns a corner its values differ by rounding, and by what it does in a hair of time.
    const double rate =
        std::max(std::fabs(piece_.belt_rate[node_count - 1]), std::fabs(field_.belt_slope(now_.hi).rate));
    const double hair = 64 * rounding * std::fabs(now_.hi) + (piece_.passed ? 4 * piece_.h : 0);
    const double corner = 64 * rounding * (std::fabs(belt()) + std::fabs(before)) + rate * hair;
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
    corners_.stop();
    return true;
}

/// Jumps and kinks come back when what acts with a delay sees them, each time smoother.
void Engine::echo(double t, int generation) {
    if (generation > most_echoes) return;
    for (const double by : field_.delays()) {
        const std::pair<double, int> back{t + by, generation};
        echoes_.insert(std::lower_bound(echoes_.begin(), echoes_.end(), back), back);
    }
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
    const double place = standstill_.arrived_at({now_.hi, theta(), pull(M)});
    if (place != theta()) y_[0] = place - origin_;
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
