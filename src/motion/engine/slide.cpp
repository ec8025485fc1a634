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
constexpr double way_back = 4;           // rate at which the motion returns to the surface, in the same units

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
Slides::Side Slides::on(const Sliding& of, Which which, const Moment& at) const {
    Piecewise& function = *of.function;
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
    if (of.of_place) {
        constexpr double stretch = 1e-4;  // in time units of the motion
        side.off = side.margin, side.speed = side.rate;
        side.margin = 2 * side.speed + way_back / unit_ * side.off;
        side.rate = function.margin_bend(at, side.rates, n, stretch * unit_);
    }
    return side;
}

Slides::Sides Slides::both(const Sliding& of, const Moment& at) const {
    return {on(of, Which::own, at), on(of, Which::beyond, at)};
}

double Slides::belt_rate(std::size_t joint, const Moment& at) const {
    constexpr double stretch = 1e-3;  // in time units of the motion
    return mechanics_.belt_slope(joint, towards(at.t, at.side), stretch * unit_).rate;
}

/// The share of the load from beyond. A small feedback returns the motion to the surface, from which rounding moves it.
double Slides::share(const Sliding& of, const Moment& at) const {
    const auto [own, beyond] = both(of, at);
    // If contacts hold the velocities of the surface, the loads do not move the motion off it: one side is used.
    if (!Sides{own, beyond}.differ()) return own.rate < 0 ? 1 : 0;
    return (own.rate + way_back / unit_ * own.margin) / (own.rate - beyond.rate);
}

std::optional<Slides::Sliding> Slides::owner_of(Piecewise& function, double t) const {
    std::optional<Sliding> owner;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        mechanics_.loads()[j].for_each_piecewise(t, [&](Piecewise& each) {
            if (&each == &function) owner = {.function = &function, .joint = j};
        });
    }
    if (mechanics_.state_of(function)) owner = {.function = &function, .joint = std::nullopt};
    return owner;
}

/// Moves velocities and states, at a place velocities and angles, onto the surface, along the difference of both sides'
/// rates; `work` receives the load's work.
void Slides::put_on_surface(const Sliding& of, const Sides& sides, Now& now, double& work) const {
    const std::size_t n = mechanics_.bodies();
    const auto& [own, beyond] = sides;
    const double by = (of.of_place ? own.speed : own.margin) / (beyond.rate - own.rate);
    for (std::size_t k = n; k < (of.of_place ? 2 * n : now.y.size()); ++k) {
        const double change = -by * (beyond.rates[k] - own.rates[k]);
        if (of.of_place && change != 0)
            now.y[k - n] += change / by * own.off / (beyond.rate - own.rate), now.low[k - n] = 0;
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
        // Other surfaces part from this one a little later; both sides must be nearer than they.
        const double away = (rates.empty() ? 1 : 1e-3) * near * unit_ * by * of.jump;
        one_side[k] += away, other_side[k] -= away;
    };
    if (of.of_place) {
        constexpr double tiny = 1e-12;  // beyond the rounding of angles, within a passage
        for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
            const double away =
                std::copysign(tiny * (std::fabs(one_side[body]) + unit_ * std::fabs(one_side[n + body]) +
                                      std::fabs(of.jump) * unit_ * unit_ / mechanics_.own_inertia(body)),
                              by);
            one_side[body] += away, other_side[body] -= away;
        }
    } else if (of.joint) {
        for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
            apart(n + body, by / mechanics_.system().bodies[body].inertia);
        }
    } else {
        apart(2 * n + *mechanics_.state_of(*of.function), 1);
    }
    const Moment here = now.here();
    const double t = here.t + later * unit_;
    const auto share_at = [this, of](const Moment& at) { return share(of, at); };
    const std::size_t bits = mechanics_.system().named ? n : 1;
    const std::uint64_t angles = bits < 64 ? (std::uint64_t{1} << bits) - 1 : 0, all = ~std::uint64_t{0};
    if (!of.function->slide({t, here.side, one_side}, {t, here.side, other_side}, share_at, of.of_place ? angles : all))
        return {};
    Sides sides = both(of, here);
    const double fastest =
        std::max(std::fabs(sides.own.rate), std::fabs(sides.beyond.rate)) * (of.of_place ? unit_ : 1);
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
    if (holds && of.of_place) return {};
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

/// Returns whether passages of a place with the present speed become no longer, because the motion returns no faster
/// than it leaves. Otherwise it leaves the place for good, however slowly.
bool Slides::passes_fade(const Sliding& of, const Now& now, const Sides& sides) {
    constexpr double rounded = 1e-12, short_passage = 1e-5;  // the second one in time units of the motion
    const std::size_t n = mechanics_.bodies();
    const double jump = sides.beyond.rate - sides.own.rate, speed = std::fabs(sides.own.speed);
    if (speed > short_passage * unit_ * std::min(-sides.own.rate, sides.beyond.rate)) return false;
    double out = 1, back = 1;
    for (const double way : {1.0, -1.0}) {
        std::vector<double> y = now.y;
        for (std::size_t k = n; k < 2 * n; ++k) {
            y[k] += (way * speed - sides.own.speed) / jump * (sides.beyond.rates[k] - sides.own.rates[k]);
        }
        const Sides there = both(of, {now.t.hi, now.side(), y});
        (way > 0 ? out : back) *= -there.own.rate, (way > 0 ? back : out) *= there.beyond.rate;
    }
    return back <= (1 + rounded) * out;
}

std::optional<Slides::Begun> Slides::begin(Piecewise& function, const Crossing& crossing, Now& now) {
    constexpr std::size_t most = 2;  // evaluating one slide evaluates the others
    if (sliding_.size() >= most) return {};
    auto owner = owner_of(function, now.t.hi);
    if (!owner || (crossing.of_place && !owner->joint)) return {};
    owner->jump = crossing.jump, owner->of_place = crossing.of_place;
    const Piecewise before = function;
    const Now then = now;
    const auto no = [&] {
        function = before, now = then;
        return std::nullopt;
    };
    const auto first = meet(*owner, now, crossing.rates);
    if (!first || (owner->of_place && !passes_fade(*owner, now, *first))) return no();
    Begun begun{owner->joint, 0};
    put_on_surface(*owner, *first, now, begun.work);
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
    if (sides && sides->own.margin == 0) begin(function, {.jump = of.jump}, now);
}

void Slides::drop(const Piecewise& function) {
    sliding_.erase(std::find_if(sliding_.begin(), sliding_.end(),
                                [&](const Sliding& each) { return each.function == &function; }));
}

/// Moves all slides onto the pieces behind a break.
void Slides::renew(Now& now, std::vector<SlideChange>& changes) {
    for (const Sliding& was : std::vector<Sliding>(sliding_)) {
        drop(*was.function);
        if (begin(*was.function, {.jump = was.jump, .of_place = was.of_place}, now)) continue;
        was.function->let_go(), changes.push_back({was.joint, false});
    }
}

/// Ends slides whose surface is held by contacts. The motion stays on the side into which these move it.
void Slides::end_lost(const Now& now, std::vector<SlideChange>& changes) {
    for (const Sliding& was : std::vector<Sliding>(sliding_)) {
        const Sides sides = both(was, now.here());
        if (sides.differ()) continue;
        drop(*was.function);
        was.function->leave(sides.own.rate < 0 ? 1 : 0);
        left_at_ = now.t.hi, left_ = was.function;
        changes.push_back({was.joint, false});
    }
}

/// The rates of y along another condition of a slide that is crossed: those of the mixture that stays on it, if the
/// loads move the motion across it.
std::optional<std::vector<double>> Slides::rates_along(const Sliding& of, std::size_t condition, const Now& now,
                                                       const Sides& sides) const {
    const double later = 10 * near * unit_;
    const auto with = [&](double more) {
        std::vector<double> rates = sides.mixed();
        for (std::size_t k = 0; k < rates.size(); ++k) rates[k] += more * (sides.beyond.rates[k] - sides.own.rates[k]);
        return rates;
    };
    const auto margin = [&](double more) {
        std::vector<double> y = with(more), margins;
        for (std::size_t k = 0; k < y.size(); ++k) y[k] = now.y[k] + later * y[k];
        of.function->margins({now.t.hi + later, engine::Side::at, y}, margins);
        return margins[condition];
    };
    const double none = margin(0), whole = margin(1), more = none / (none - whole);
    if (!(std::fabs(more) <= 2)) return {};
    return with(more);
}

bool Slides::leave(Piecewise& function, std::size_t condition, Now& now, std::vector<SlideChange>& changes) {
    const auto found = std::find_if(sliding_.begin(), sliding_.end(),
                                    [&](const Sliding& sliding) { return sliding.function == &function; });
    if (found == sliding_.end()) return false;
    const Sliding was = *found;
    const Sides before = both(was, now.here());
    sliding_.erase(found);
    if (condition > 1 && before.differ()) {  // both sides may have a new piece on which the slide continues
        const std::vector<double> rates = before.mixed();
        const auto along = rates_along(was, condition, now, before);
        if (begin(function, {was.jump, was.of_place, rates}, now)) return true;
        if (along && begin(function, {was.jump, false, *along}, now)) return true;
        const auto sides = decide(was, now, rates);
        if (sides) condition = sides->own.rate < 0 ? 1 : 0;
    }
    function.leave(condition);
    changes.push_back({was.joint, false});
    return true;
}

std::vector<SlideChange> Slides::end() {
    std::vector<SlideChange> changes;
    for (const Sliding& sliding : sliding_) sliding.function->let_go(), changes.push_back({sliding.joint, false});
    sliding_.clear();
    return changes;
}

}  // namespace dinal::motion::engine
