#include "motion/engine/slide.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace dinal::motion::engine {

using Which = Piecewise::Slide::Side;

namespace {

// distance from the surface at which both sides are evaluated, in time units of the motion
constexpr double near = 1e-9;
constexpr double clearly_apart = 1e-12;  // relative to the difference between both sides

bool sticks(std::size_t joint, const Now& now) {
    return now.rubs(joint) && now.mode.friction[joint].way == model::Motion::stuck && !now.mode.keeps_place(joint);
}

}  // namespace

bool Slides::Sides::differ() const {
    return beyond.rate - own.rate > 1e-9 * (std::fabs(own.rate) + std::fabs(beyond.rate));
}

bool Slides::Sides::drive_back() const {
    const double least = clearly_apart * (std::fabs(own.rate) + std::fabs(beyond.rate));
    return own.rate < -least && beyond.rate > least;
}

std::vector<double> Slides::Sides::mixed() const {
    const double share = own.rate / (own.rate - beyond.rate);
    std::vector<double> rates = own.rates;
    for (std::size_t k = 0; k < rates.size(); ++k) rates[k] += share * (beyond.rates[k] - own.rates[k]);
    return rates;
}

/// Returns margin and rates of the motion with the load of one side of the surface.
Slides::Side Slides::on(Piecewise& function, Which which, const Moment& at) const {
    const std::size_t n = mechanics_.bodies();
    const Which before = std::exchange(function.sliding().asked, which);
    std::vector<double> loads, torques, belts(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mechanics_.belt(j, at.t, at.side);
    mechanics_.loads_of_time(at.t, at.side, loads);
    mechanics_.torques(at, mode_, belts, loads, torques);
    const Frame& frame = frames_.of(mode_);
    std::vector<double> of_group(frame.groups()), offsets(n);
    if (mechanics_.has_belts()) {
        for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mode_.holds(j) ? belt_rate(j, at) : 0;
        frame.offsets(belts, mode_, offsets);
    }
    Side side;
    side.rates.assign(at.y.size(), 0);
    for (std::size_t i = 0; i < n; ++i) {
        const double own = torques[i] - mechanics_.system().bodies[i].inertia * offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) of_group[group] += by * own;
    }
    for (std::size_t i = 0; i < n; ++i) {
        side.rates[i] = at.y[n + i], side.rates[n + i] = offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) {
            side.rates[n + i] += by * (of_group[group] / frame.inertia[group]);
        }
    }
    if (mechanics_.states() > 0) mechanics_.rates(at, side.rates.data() + 2 * n, &mode_);
    function.sliding().asked = before;
    std::tie(side.margin, side.rate) = function.margin(at, side.rates);
    return side;
}

double Slides::belt_rate(std::size_t joint, const Moment& at) const {
    constexpr double stretch = 1e-3;  // in time units of the motion
    return mechanics_.belt_slope(joint, towards(at.t, at.side), stretch * unit_).rate;
}

/// The share of the load from beyond. A small feedback returns the motion to the surface, from which rounding moves it.
double Slides::share(Piecewise& function, const Moment& at) const {
    const double back = 4 / unit_;
    const Side own = on(function, Which::own, at), beyond = on(function, Which::beyond, at);
    // If contacts hold the velocities of the surface, the loads do not move the motion off it: one side is used.
    if (!Sides{own, beyond}.differ()) return own.rate < 0 ? 1 : 0;
    return (own.rate + back * own.margin) / (own.rate - beyond.rate);
}

std::optional<Slides::Sliding> Slides::owner_of(Piecewise& function, double t) const {
    std::optional<Sliding> owner;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        mechanics_.loads()[j].for_each_piecewise(t, [&](Piecewise& each) {
            if (&each == &function) owner = {&function, j};
        });
    }
    if (mechanics_.state_of(function)) owner = {&function, std::nullopt};
    return owner;
}

/// Moves velocities and states onto the surface, along the difference of both sides' rates; `work` receives the load's
/// work.
void Slides::put_on_surface(const Sides& sides, Now& now, double& work) const {
    const std::size_t n = mechanics_.bodies();
    const auto& [own, beyond] = sides;
    const double by = own.margin / (beyond.rate - own.rate);
    for (std::size_t k = n; k < now.y.size(); ++k) {
        const double change = -by * (beyond.rates[k] - own.rates[k]);
        if (k < 2 * n) work += mechanics_.own_inertia(k - n) * change * (now.y[k] + change / 2);
        now.y[k] += change;
    }
}

/// If rates are given, evaluates both sides slightly later on the motion, so that a condition that was just crossed has
/// its new decision.
std::optional<Slides::Sides> Slides::decide(const Sliding& of, const Now& now, const std::vector<double>& rates) {
    const double later = rates.empty() ? 0 : 10 * near;
    const std::size_t n = mechanics_.bodies();
    std::vector<double> one_side = now.y;
    for (std::size_t k = 0; k < rates.size(); ++k) one_side[k] += later * unit_ * rates[k];
    std::vector<double> other_side = one_side;
    const auto apart = [&](std::size_t k, double by) {
        const double away = near * unit_ * by * of.jump;
        one_side[k] += away, other_side[k] -= away;
    };
    if (of.joint) {
        for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
            apart(n + body, by / mechanics_.system().bodies[body].inertia);
        }
    } else {
        apart(2 * n + *mechanics_.state_of(*of.function), 1);
    }
    const Moment here = now.here();
    const double t = here.t + later * unit_;
    const auto share_at = [this, &function = *of.function](const Moment& at) { return share(function, at); };
    if (!of.function->slide({t, here.side, one_side}, {t, here.side, other_side}, share_at)) return {};
    Sides sides{on(*of.function, Which::own, here), on(*of.function, Which::beyond, here)};
    const double fastest = std::max(std::fabs(sides.own.rate), std::fabs(sides.beyond.rate));
    of.function->watch_others({t, here.side, one_side}, {t, here.side, other_side}, near * unit_ * fastest);
    return sides;
}

bool Slides::stands(Piecewise& function, const Now& now) const {
    const auto owner = owner_of(function, now.t.hi);
    return owner && owner->joint && sticks(*owner->joint, now);
}

/// Finds the sides of a slide. If a sticking contact holds the velocities of the surface, it must be about to slip
/// along it in one direction.
std::optional<Slides::Sides> Slides::meet(const Sliding& of, const Now& now, const std::vector<double>& rates) {
    mode_ = now.mode;
    const bool holds = of.joint && sticks(*of.joint, now);
    for (const model::Motion way : {model::Motion::forward, model::Motion::backward}) {
        if (holds) mode_.friction[*of.joint].way = way;
        auto sides = decide(of, now, rates);
        if (!sides || !sides->drive_back()) continue;
        if (!holds) return sides;
        const std::vector<double> mixed = sides->mixed();
        double slip = -belt_rate(*of.joint, now.here()), across = 0;
        for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
            const std::size_t v = mechanics_.bodies() + body;
            slip += by * mixed[v], across += std::fabs(by * (sides->own.rates[v] - sides->beyond.rates[v]));
        }
        if (slip * model::sign_of(way) > clearly_apart * across) return sides;
    }
    return {};
}

std::optional<Slides::Begun> Slides::begin(Piecewise& function, double jump, Now& now,
                                           const std::vector<double>& rates) {
    constexpr std::size_t most = 2;  // evaluating one slide evaluates the others
    if (sliding_.size() >= most) return {};
    auto owner = owner_of(function, now.t.hi);
    if (!owner) return {};
    owner->jump = jump;
    const Piecewise before = function;
    const std::vector<double> y = now.y;
    const auto no = [&] {
        function = before, now.y = y;
        return std::nullopt;
    };
    const auto first = meet(*owner, now, rates);
    if (!first) return no();
    Begun begun{owner->joint, 0};
    put_on_surface(*first, now, begun.work);
    const auto sides = decide(*owner, now, first->mixed());
    if (!sides || !sides->drive_back()) return no();
    sliding_.push_back(*owner);
    return begun;
}

void Slides::start(Piecewise& function, Now& now) {
    if (!stands(function, now)) return;
    const Piecewise before = function;
    Sliding of = *owner_of(function, now.t.hi);
    of.jump = mechanics_.size_of(*of.joint, now.here());
    const auto sides = meet(of, now, {});
    function = before;
    if (sides && sides->own.margin == 0) begin(function, of.jump, now);
}

bool Slides::leave(Piecewise& function, std::size_t condition, Now& now, std::vector<SlideChange>& changes) {
    const auto found = std::find_if(sliding_.begin(), sliding_.end(),
                                    [&](const Sliding& sliding) { return sliding.function == &function; });
    if (found == sliding_.end()) return false;
    const Sliding was = *found;
    const Sides before{on(function, Which::own, now.here()), on(function, Which::beyond, now.here())};
    sliding_.erase(found);
    if (condition > 1 && before.differ()) {  // both sides may have a new piece on which the slide continues
        const std::vector<double> rates = before.mixed();
        if (begin(function, was.jump, now, rates)) return true;
        const auto sides = decide(was, now, rates);
        if (sides) condition = sides->own.rate < 0 ? 1 : 0;
    }
    function.leave(condition);
    changes.push_back({was.joint, false});
    return true;
}

bool Slides::lost(const Moment& here) const {
    return std::any_of(sliding_.begin(), sliding_.end(), [&](const Sliding& sliding) {
        return !Sides{on(*sliding.function, Which::own, here), on(*sliding.function, Which::beyond, here)}.differ();
    });
}

std::vector<SlideChange> Slides::end() {
    std::vector<SlideChange> changes;
    for (const Sliding& sliding : sliding_) sliding.function->let_go(), changes.push_back({sliding.joint, false});
    sliding_.clear();
    return changes;
}

}  // namespace dinal::motion::engine
