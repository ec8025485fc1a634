#include "motion/engine/slide.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "algebra/decompositions.hpp"

namespace dinal::motion::engine {

using Which = Piecewise::Slide::Side;

namespace {

// distance from the surface at which both sides are evaluated, in time units of the motion
constexpr double near = 1e-9;
constexpr double clearly_apart = 1e-12;  // relative to the difference between both sides
constexpr double way_back = 4;           // rate at which the motion returns to the surface, in the same units

constexpr double short_passage = 1e-5;  // duration of the passage of a place, in time units of the motion
constexpr double hardly = 1e-9;         // fraction of a rate below which it counts as 0

/// Solves for the shares with which several slides stay on their surfaces. A row has the changes of the rate of one
/// margin by each share, and then this rate with shares 0. Where contacts hold a surface, no load moves the motion off
/// it, and one side is used.
std::vector<double> solve_for_shares(std::vector<std::vector<double>> rows) {
    const std::size_t count = rows.size();
    std::vector<double> sizes(count, std::numeric_limits<double>::min()), shares;
    for (std::size_t k = 0; k < count; ++k) {
        for (const double entry : rows[k]) sizes[k] = std::max(sizes[k], std::fabs(entry));
    }
    std::vector<std::size_t> left(count);
    std::iota(left.begin(), left.end(), 0);
    while (!left.empty()) {
        const auto weight = [&](std::size_t k) { return std::fabs(rows[k][k]) / sizes[k]; };
        const auto best = std::max_element(left.begin(), left.end(),
                                           [&](std::size_t a, std::size_t b) { return weight(a) < weight(b); });
        const std::size_t k = *best;
        left.erase(best);
        std::vector<double>& row = rows[k];
        if (weight(k) > hardly) {
            const double by = row[k];
            for (double& entry : row) entry /= by;
        } else {
            const double share = row.back() < 0 ? 1 : 0;
            row.assign(count + 1, 0), row[k] = 1, row.back() = -share;
        }
        for (std::size_t i = 0; i < count; ++i) {
            const double by = i == k ? 0 : rows[i][k];
            for (std::size_t c = 0; c <= count && by != 0; ++c) rows[i][c] -= by * row[c];
        }
    }
    for (const std::vector<double>& row : rows) shares.push_back(-row.back());
    return shares;
}

bool sticks(std::size_t joint, const Now& now) {
    return now.rubs(joint) && now.mode.friction[joint].way == model::Motion::stuck && !now.mode.keeps_place(joint);
}

}  // namespace

bool Slides::Sides::differ() const {
    return beyond.rate - own.rate > hardly * (std::fabs(own.rate) + std::fabs(beyond.rate));
}

bool Slides::Sides::drive_back() const {
    const double least = clearly_apart * (std::fabs(own.rate) + std::fabs(beyond.rate));
    return own.rate < -least && beyond.rate > least;
}

bool Slides::Sides::at_limit() const {
    const double least = clearly_apart * (std::fabs(own.rate) + std::fabs(beyond.rate));
    return own.rate <= least && beyond.rate >= -least && differ();
}

std::vector<double> Slides::Sides::mixed() const {
    const double share = own.rate / (own.rate - beyond.rate);
    std::vector<double> rates = own.rates;
    for (std::size_t k = 0; k < rates.size(); ++k) rates[k] += share * (beyond.rates[k] - own.rates[k]);
    return rates;
}

template <class F>
void Slides::Sliding::each(const F& call) const {
    call(*function);
    for (Piecewise* other : along) call(*other);
}

void Slides::Sliding::use_side(Which which) const {
    each([which](Piecewise& one) { one.sliding().used = which; });
}

/// Adds the beginning or end of the slide of each load, or of a rate if no load slides.
void Slides::Sliding::add_changes(bool begins, std::vector<SlideChange>& changes) const {
    for (const std::size_t loaded : joints) changes.push_back({loaded, begins});
    if (joints.empty()) changes.push_back({std::nullopt, begins});
}

bool Slides::Sliding::has(const Piecewise& one) const {
    return function == &one || std::find(along.begin(), along.end(), &one) != along.end();
}

/// Returns the rates of y with the selected sides of the sliding functions.
std::vector<double> Slides::rates_at(const Moment& at) const {
    const std::size_t n = mechanics_.bodies();
    std::vector<double> loads, torques, belts(mechanics_.joints());
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mechanics_.belt(j, at.t, at.side);
    mechanics_.loads_of_time(at.t, at.side, loads);
    mechanics_.torques(at, mode_, belts, loads, torques);
    const Frame& frame = frames_.of(mode_);
    std::vector<double> of_group(frame.groups()), offsets(n), rates(at.y.size());
    if (mechanics_.has_belts()) {
        for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mode_.holds(j) ? belt_rate(j, at) : 0;
        frame.offsets(belts, mode_, offsets);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double own = torques[i] - mechanics_.system().bodies[i].inertia * offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) of_group[group] += by * own;
    }
    for (std::size_t i = 0; i < n; ++i) {
        rates[i] = at.y[n + i], rates[n + i] = offsets[i];
        for (const auto& [group, by] : frame.bodies[i]) rates[n + i] += by * (of_group[group] / frame.inertia[group]);
    }
    if (mechanics_.states() > 0) mechanics_.rates(at, rates.data() + 2 * n, &mode_);
    return rates;
}

std::vector<double> Slides::free_rates(const Mode& mode, const Moment& at) {
    mode_ = mode;
    return rates_at({at.t, at.side, at.y, true});
}

double Slides::slip_rate(std::size_t joint, const std::vector<double>& rates, const Moment& at) const {
    return mechanics_.velocity(joint, rates) - belt_rate(joint, at);
}

/// Returns the margin of a slide and its rate, for these rates of y.
Slides::Side Slides::side_of(const Sliding& of, const Moment& at, std::vector<double> rates) const {
    Side side{.rates = std::move(rates)};
    std::tie(side.margin, side.rate) = of.function->margin(at, side.rates);
    if (of.of_place) {
        constexpr double stretch = 1e-4;  // in time units of the motion
        side.off = side.margin, side.speed = side.rate;
        side.margin = 2 * side.speed + way_back / unit_ * side.off;
        side.rate = of.function->margin_bend(at, side.rates, mechanics_.bodies(), stretch * unit_);
    }
    return side;
}

/// Evaluates the rates of y on both sides of each slide. They are linear in the shares.
Slides::Mixing Slides::mixing(std::vector<const Sliding*> of, const Moment& at) const {
    Mixing all{.of = std::move(of)};
    std::vector<Which> before;
    for (const Sliding* each : all.of) before.push_back(each->function->sliding().used), each->use_side(Which::own);
    all.own = rates_at(at);
    for (const Sliding* each : all.of) {
        each->use_side(Which::beyond);
        all.beyond.push_back(rates_at(at));
        each->use_side(Which::own);
    }
    for (std::size_t k = 0; k < all.of.size(); ++k) all.of[k]->use_side(before[k]);
    return all;
}

/// Adds the mixtures that keep the slides `staying` on their surfaces to the rates. Returns their shares.
std::vector<double> Slides::keep(const Mixing& all, const std::vector<std::size_t>& staying, const Moment& at,
                                 std::vector<double>& rates) const {
    std::vector<std::vector<double>> rows;
    for (const std::size_t k : staying) {
        std::vector<double>& row = rows.emplace_back();
        const Side without = side_of(*all.of[k], at, rates);
        const double own = side_of(*all.of[k], at, all.own).rate;
        for (const std::size_t j : staying) row.push_back(side_of(*all.of[k], at, all.beyond[j]).rate - own);
        row.push_back(without.rate + way_back / unit_ * without.margin);
    }
    std::vector<double> shares = solve_for_shares(std::move(rows));
    for (std::size_t j = 0; j < staying.size(); ++j) {
        for (std::size_t i = 0; i < rates.size(); ++i) rates[i] += shares[j] * (all.beyond[staying[j]][i] - all.own[i]);
    }
    return shares;
}

/// Returns both sides of a slide, while all others stay on their surfaces.
Slides::Sides Slides::both(const Sliding& of, const Moment& at) const {
    std::vector<const Sliding*> slides{&of};
    for (const Sliding& each : sliding_) {
        if (each.function != of.function) slides.push_back(&each);
    }
    std::vector<std::size_t> others(slides.size() - 1);
    std::iota(others.begin(), others.end(), 1);
    const Mixing all = mixing(std::move(slides), at);
    std::vector<double> own = all.own, beyond = all.beyond.front();
    keep(all, others, at, own), keep(all, others, at, beyond);
    return {side_of(of, at, std::move(own)), side_of(of, at, std::move(beyond))};
}

double Slides::belt_rate(std::size_t joint, const Moment& at) const {
    constexpr double stretch = 1e-3;  // in time units of the motion
    return mechanics_.belt_slope(joint, towards(at.t, at.side), stretch * unit_).rate;
}

/// The share of the load from beyond. A small feedback returns the motion to the surface, from which rounding moves it.
double Slides::share(const Sliding& of, const Moment& at) const {
    const auto [own, beyond] = both(of, at);
    // If contacts hold the velocities of the surface, the loads do not move the motion off it: one side is used.
    if (!Sides{own, beyond}.differ()) return falls_if_held(of, own, at) ? 1 : 0;
    return (own.rate + way_back / unit_ * own.margin) / (own.rate - beyond.rate);
}

std::optional<Slides::Sliding> Slides::owner_of(Piecewise& function, double t) const {
    const auto joint = mechanics_.joint_of(function, t);
    if (!joint && !mechanics_.state_of(function)) return {};
    return Sliding{.function = &function, .joint = joint};
}

/// Returns the derivatives of a slide's margin: by time, and by each variable of the state.
std::vector<double> Slides::gradient(const Piecewise& function, const Moment& at) {
    std::vector<double> rates(at.y.size(), 0), slopes{function.margin(at, rates).second};
    for (double& rate : rates) {
        rate = 1;
        slopes.push_back(function.margin(at, rates).second - slopes.front());
        rate = 0;
    }
    return slopes;
}

/// Returns whether a function slides along the surface of a slide: whether the gradients of their margins are parallel.
/// A place also holds its velocity, so that a margin of both lies on the surface, too, if the place stands still.
bool Slides::is_same_surface(const Sliding& of, const Piecewise& other, const Moment& at) const {
    constexpr double nearly = 1 - 1e-12;
    const std::vector<double> slopes = gradient(*of.function, at), others = gradient(other, at);
    const auto product = [](std::span<const double> a, std::span<const double> b) {
        return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
    };
    const auto parallel = [&](std::span<const double> a, std::span<const double> b) {
        return std::fabs(product(a, b)) >= nearly * std::sqrt(product(a, a)) * std::sqrt(product(b, b));
    };
    if (!of.of_place || slopes[0] != 0) return parallel(slopes, others);
    const std::size_t n = mechanics_.bodies();
    const auto angles = std::span(slopes).subspan(1, n), rest = std::span(others).subspan(1 + 2 * n);
    return others[0] == 0 && std::all_of(rest.begin(), rest.end(), [](double slope) { return slope == 0; }) &&
           parallel(angles, std::span(others).subspan(1, n)) && parallel(angles, std::span(others).subspan(1 + n, n));
}

/// Returns the index of the first slope of a margin whose variables the slide holds: angles, or velocities.
std::size_t Slides::first_held(const Sliding& of) const {
    return of.of_place ? 1 : 1 + mechanics_.bodies();
}

/// Returns whether a slide holds speed 0 on a surface that does not move, to the rounding of the torques: whether
/// nothing else in its margin, with these slopes, changes.
bool Slides::stands_still(const Sliding& of, const std::vector<double>& slopes, const Moment& at) const {
    const std::size_t n = mechanics_.bodies(), first = first_held(of);
    std::vector<double> states(mechanics_.states());
    if (!states.empty()) mechanics_.rates(at, states.data(), &mode_);
    // A place that turns back stands for an instant only.
    const double later = std::min(1e-4 * unit_, (mechanics_.next_break(at.t) - at.t) / 2);
    const double then = gradient(*of.function, {at.t + later, engine::Side::at, at.y})[0];
    double moves = std::max(std::fabs(slopes[0]), std::fabs(then)), rounded = 0, speed = 0;
    for (std::size_t i = 1; i < slopes.size(); ++i) {
        const double slope = std::fabs(slopes[i]);
        if (i >= first && i < first + n) {
            const double acceleration = std::fabs(of.jump) / mechanics_.system().bodies[i - first].inertia;
            rounded += slope * 64 * rounding * acceleration * (of.of_place ? unit_ : 1);
            speed += of.of_place ? 0 : slopes[i] * at.y[i - 1];
        } else if (slope != 0) {
            moves += slope * std::fabs(i <= n ? at.y[n + i - 1] : i <= 2 * n ? 1 : states[i - 1 - 2 * n]);
        }
    }
    return moves + std::fabs(speed) / unit_ <= rounded;
}

std::vector<double> Slides::carried_by_belts(const Mode& mode, const Moment& at) const {
    std::vector<double> belts(mechanics_.joints()), carried(mechanics_.bodies());
    if (!mechanics_.has_belts()) return carried;
    for (std::size_t j = 0; j < belts.size(); ++j) belts[j] = mechanics_.belt(j, at.t, at.side);
    frames_.of(mode).offsets(belts, mode, carried);
    return carried;
}

Moment Slides::advance_with_belts(const Moment& at, const Mode& mode, std::vector<double>& y) const {
    const Moment later{mechanics_.after_turn(at.t, unit_), at.side, y};
    const std::vector<double> from = carried_by_belts(mode, at), to = carried_by_belts(mode, later);
    const std::size_t n = from.size();
    for (std::size_t i = 0; i < n; ++i) y[i] += (later.t - at.t) * y[n + i], y[n + i] += to[i] - from[i];
    return later;
}

/// Returns whether the margin falls on the own side while contacts hold the motion.
bool Slides::falls_if_held(const Sliding& of, const Side& own, const Moment& at) const {
    if (!mechanics_.has_belts()) return own.rate < 0;
    std::vector<double> soon(at.y.begin(), at.y.end());
    const Moment later = advance_with_belts(at, mode_, soon);
    const std::size_t n = mechanics_.bodies();
    for (std::size_t k = 2 * n; k < soon.size(); ++k) soon[k] += (later.t - at.t) * own.rates[k];
    std::vector<double> rates = own.rates;
    std::copy_n(soon.begin() + static_cast<std::ptrdiff_t>(n), n, rates.begin());
    const auto [then, its_rate] = of.function->margin(later, rates);
    return of.of_place ? its_rate < 0 : then < of.function->margin(at, own.rates).first;
}

bool Slides::holds_slip(std::size_t joint, const Mode& mode, const Frame& frame, const Moment& at) const {
    const std::size_t n = mechanics_.bodies();
    if (sliding_.empty()) return false;
    const std::vector<double> carried = carried_by_belts(mode, at);
    std::vector<double> rates(mechanics_.joints()), faster(n);
    for (std::size_t j = 0; j < rates.size(); ++j) {
        if (mechanics_.has_belt(j)) rates[j] = belt_rate(j, at);
    }
    if (mechanics_.has_belts()) frame.offsets(rates, mode, faster);
    if (rates[joint] != 0 || mechanics_.belt(joint, at.t, at.side) != 0) return false;
    for (const auto& [body, by] : mechanics_.system().joints[joint].of) {
        if (carried[body] != 0 || faster[body] != 0) return false;
    }
    const auto groups = static_cast<Eigen::Index>(frame.groups());
    Eigen::MatrixXd held = Eigen::MatrixXd::Zero(groups, static_cast<Eigen::Index>(sliding_.size()));
    for (std::size_t k = 0; k < sliding_.size(); ++k) {
        const std::vector<double> slopes = gradient(*sliding_[k].function, at);
        if (!stands_still(sliding_[k], slopes, at)) continue;
        const auto is_carried = [&](std::size_t i) {
            return slopes[first_held(sliding_[k]) + i] != 0 && (carried[i] != 0 || faster[i] != 0);
        };
        bool along = false;
        for (std::size_t i = 0; i < n; ++i) along = along || is_carried(i);
        for (std::size_t i = 0; i < n && !along; ++i) {
            for (const auto& [group, by] : frame.bodies[i]) {
                held(static_cast<Eigen::Index>(group), static_cast<Eigen::Index>(k)) +=
                    by * slopes[first_held(sliding_[k]) + i];
            }
        }
    }
    Eigen::VectorXd slip = Eigen::VectorXd::Zero(groups);
    for (const auto& [group, by] : frame.joints[joint]) slip(static_cast<Eigen::Index>(group)) += by;
    const Eigen::VectorXd shares = algebra::solve_least_squares(held, slip);
    return (held * shares - slip).norm() <= hardly * slip.norm();
}

/// Moves velocities and states, at a place velocities and angles, onto the surface, along the difference of both sides'
/// rates; `work` receives the load's work.
void Slides::put_on_surface(const Sliding& of, const Sides& sides, Now& now, double& work) const {
    const std::size_t n = mechanics_.bodies();
    const auto& [own, beyond] = sides;
    const double by = (of.of_place ? own.speed : own.margin) / (beyond.rate - own.rate);
    // A remainder within the rounding of the change counts as zero.
    const auto add = [](double& value, double change) {
        const double sum = value + change;
        value = std::fabs(sum) > 16 * rounding * std::fabs(change) ? sum : 0;
    };
    for (std::size_t k = n; k < (of.of_place ? 2 * n : now.y.size()); ++k) {
        const double change = -by * (beyond.rates[k] - own.rates[k]);
        if (of.of_place && change != 0)
            add(now.y[k - n], change / by * own.off / (beyond.rate - own.rate)), now.low[k - n] = 0;
        if (k < 2 * n) work += mechanics_.own_inertia(k - n) * change * (now.y[k] + change / 2);
        add(now.y[k], change);
    }
}

/// Moves y just off a place, to one side of it.
void Slides::move_aside(const Sliding& of, double side, std::vector<double>& y) const {
    constexpr double tiny = 1e-12;  // beyond the rounding of angles, within a passage
    const std::size_t n = mechanics_.bodies();
    for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
        const double away = tiny * (std::fabs(y[body]) + unit_ * std::fabs(y[n + body]) +
                                    std::fabs(of.jump) * unit_ * unit_ / mechanics_.system().bodies[body].inertia);
        y[body] += std::copysign(away, side * by);
    }
}

/// Moves y off a place, to one side of it. A slow motion is made to leave on that side, so that functions of the
/// velocity also decide.
void Slides::move_out(const Sliding& of, double side, std::vector<double>& y) const {
    constexpr double tiny = 1e-12;
    const model::Joint& joint = mechanics_.system().joints[*of.joint];
    double weights = 0, fast = 0;
    for (const auto& [body, by] : joint.of) {
        weights += by * by, fast += std::fabs(of.jump * by) * unit_ / mechanics_.system().bodies[body].inertia;
    }
    const double slip = mechanics_.velocity(*of.joint, y);
    move_aside(of, side, y);
    if (std::fabs(slip) > short_passage * fast) return;
    const double change = side * std::max(tiny * fast, std::numeric_limits<double>::min()) - slip;
    for (const auto& [body, by] : joint.of) y[mechanics_.bodies() + body] += by / weights * change;
}

/// If rates are given, evaluates both sides slightly later on the motion, so that a condition that was just crossed has
/// its new decision.
std::optional<Slides::Sides> Slides::decide(Sliding& of, const Now& now, const std::vector<double>& rates) {
    const double later = rates.empty() ? 0 : 10 * near;
    const std::size_t n = mechanics_.bodies();
    std::vector<double> one_side = now.y;
    for (std::size_t k = 0; k < rates.size(); ++k) one_side[k] += later * unit_ * rates[k];
    std::vector<double> other_side = one_side;
    const auto apart = [&](std::size_t k, double by) {
        // Along the rates, other surfaces are slightly apart from this one; both sides must be nearer than those.
        const double away = (rates.empty() ? 1 : 1e-3) * near * unit_ * by * of.jump;
        one_side[k] += away, other_side[k] -= away;
    };
    if (of.of_place) {
        move_out(of, 1, one_side), move_out(of, -1, other_side);
    } else if (of.joint) {
        for (const auto& [body, by] : mechanics_.system().joints[*of.joint].of) {
            apart(n + body, by / mechanics_.system().bodies[body].inertia);
        }
    } else {
        apart(2 * n + *mechanics_.state_of(*of.function), 1);
    }
    const Moment here = now.here();
    const double t = here.t + later * unit_;
    const std::size_t bits = mechanics_.system().named ? n : 1;
    const std::uint64_t angles = bits < 64 ? (std::uint64_t{1} << bits) - 1 : 0, all = ~std::uint64_t{0};
    const Moment own{t, here.side, one_side}, beyond{t, here.side, other_side};
    if (!of.function->slide(own, beyond, of.of_place ? angles : all)) return {};
    of.along.clear();
    mechanics_.for_each_piecewise(here.t, [&](Piecewise& each) {
        if (each.is_friction() || &each == of.function || slide_of(each) != sliding_.end()) return;
        const Piecewise before = each;
        if (each.slide(own, beyond) && is_same_surface(of, each, here)) {
            of.along.push_back(&each);
        } else {
            each = before;
            if (each.slides()) each.let_go();
        }
    });
    of.joints.clear();
    of.each([&](Piecewise& each) {
        each.sliding().share = [this, of](const Moment& at) { return share(of, at); };
        const auto loaded = mechanics_.joint_of(each, here.t);
        if (loaded && std::find(of.joints.begin(), of.joints.end(), *loaded) == of.joints.end())
            of.joints.push_back(*loaded);
    });
    Sides sides = both(of, here);
    const double fastest =
        std::max(std::fabs(sides.own.rate), std::fabs(sides.beyond.rate)) * (of.of_place ? unit_ : 1);
    of.each([&](Piecewise& each) { each.watch_others(own, beyond, near * unit_ * fastest); });
    return sides;
}

bool Slides::drive_back(const Sliding& of, const Now& now, const Sides& sides) const {
    if (sides.drive_back() || !sides.at_limit()) return sides.drive_back();
    const double later = 1e3 * near * unit_;
    const std::vector<double> rates = sides.mixed();
    std::vector<double> y = now.y;
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += later * rates[k];
    return both(of, {now.t.hi + later, engine::Side::at, y}).drive_back();
}

bool Slides::stands(Piecewise& function, const Now& now) const {
    const auto owner = owner_of(function, now.t.hi);
    return owner && owner->joint && sticks(*owner->joint, now);
}

/// Finds the sides of a slide. If a sticking contact holds the velocities of the surface, it must be about to slip
/// along it in one direction.
std::optional<Slides::Sides> Slides::find_sides(Sliding& of, const Now& now, const std::vector<double>& rates) {
    mode_ = now.mode;
    const bool holds = of.joint && sticks(*of.joint, now);
    if (holds && of.of_place) return {};
    for (const model::Motion way : {model::Motion::forward, model::Motion::backward}) {
        if (holds) mode_.friction[*of.joint].way = way;
        auto sides = decide(of, now, rates);
        if (!sides || !drive_back(of, now, *sides)) continue;
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

/// Returns the rate of a slide's margin with the functions that slide evaluated as they are at y, while all others stay
/// on their surfaces.
double Slides::rate_beside(const Sliding& of, const Now& now, const std::vector<double>& y) {
    const Moment at{now.t.hi, now.side(), y};
    std::vector<Piecewise> before;
    of.each([&](Piecewise& each) { before.push_back(each), each.let_go(); });
    std::vector<const Sliding*> others;
    for (const Sliding& each : sliding_) others.push_back(&each);
    std::vector<std::size_t> all_of_them(others.size());
    std::iota(all_of_them.begin(), all_of_them.end(), 0);
    const Mixing all = mixing(std::move(others), at);
    std::vector<double> rates = all.own;
    keep(all, all_of_them, at, rates);
    auto was = before.begin();
    of.each([&](Piecewise& each) { each = *was++; });
    return side_of(of, at, std::move(rates)).rate;
}

/// Returns whether passages of a place with the present speed become no longer, because the motion returns no faster
/// than it leaves. Otherwise it leaves the place for good, however slowly.
bool Slides::passes_fade(const Sliding& of, const Now& now, const Sides& sides) {
    constexpr double rounded = 1e-12, tiny = 1e-12;
    const std::size_t n = mechanics_.bodies();
    const double jump = sides.beyond.rate - sides.own.rate, speed = std::fabs(sides.own.speed);
    if (speed > short_passage * unit_ * std::min(-sides.own.rate, sides.beyond.rate)) return false;
    const double least = tiny * unit_ * std::min(-sides.own.rate, sides.beyond.rate);
    const auto drives_back = [&](double side, double way) {
        std::vector<double> y = now.y;
        for (std::size_t k = n; k < 2 * n; ++k) {
            y[k] +=
                (way * std::max(speed, least) - sides.own.speed) / jump * (sides.beyond.rates[k] - sides.own.rates[k]);
        }
        move_aside(of, side, y);
        return -side * rate_beside(of, now, y);
    };
    double out = 1, back = 1;
    for (const double side : {1.0, -1.0}) out *= drives_back(side, side), back *= drives_back(side, -side);
    return back <= (1 + rounded) * out;
}

/// All functions as they are now.
std::vector<std::pair<Piecewise*, Piecewise>> Slides::all_functions(double t) {
    std::vector<std::pair<Piecewise*, Piecewise>> all;
    mechanics_.for_each_piecewise(t, [&all](Piecewise& each) { all.emplace_back(&each, each); });
    return all;
}

/// Returns whether a function that is not read also jumps at the surface: it has no share and would stay on one side.
bool Slides::others_jump(const Sliding& of, const Now& now, const Sides& sides) const {
    if (!mechanics_.samples_the_motion()) return false;
    constexpr double clearly = 1e-2;
    const std::size_t n = mechanics_.bodies();
    std::vector<double> ahead = now.y, behind = now.y;
    double jump = 0, other = 0;
    for (std::size_t k = n; k < now.y.size(); ++k) {
        const double change = sides.beyond.rates[k] - sides.own.rates[k], away = near * unit_ * change;
        ahead[k] += away, behind[k] -= away;
        if (k < 2 * n) ahead[k - n] += unit_ * away, behind[k - n] -= unit_ * away;
        jump += std::fabs(change);
    }
    of.use_side(Which::own);
    const std::vector<double> rates_ahead = rates_at({now.t.hi, now.side(), ahead}),
                              rates_behind = rates_at({now.t.hi, now.side(), behind});
    of.use_side(Which::both);
    for (std::size_t k = n; k < now.y.size(); ++k) other += std::fabs(rates_ahead[k] - rates_behind[k]);
    return other > clearly * jump;
}

std::optional<Slides::Begun> Slides::begin(Piecewise& function, const Crossing& crossing, Now& now) {
    auto owner = owner_of(function, now.t.hi);
    if (!owner || (crossing.of_place && !owner->joint)) return {};
    owner->jump = crossing.jump, owner->of_place = crossing.of_place;
    const auto before = all_functions(now.t.hi);
    const Now then = now;
    const auto no = [&] {
        for (const auto& [each, was] : before) *each = was;
        now = then;
        return std::nullopt;
    };
    const auto first = find_sides(*owner, now, crossing.rates);
    if (!first || (owner->of_place && !passes_fade(*owner, now, *first))) return no();
    Begun begun;
    put_on_surface(*owner, *first, now, begun.work);
    const auto sides = decide(*owner, now, first->mixed());
    if (!sides || !drive_back(*owner, now, *sides) || others_jump(*owner, now, *sides)) return no();
    sliding_.push_back(*owner);
    owner->add_changes(true, begun.changes.slides);
    owner->each([&](Piecewise& each) { begun.changes.functions.push_back(&each); });
    return begun;
}

void Slides::start(Piecewise& function, Now& now) {
    if (!stands(function, now)) return;
    const auto before = all_functions(now.t.hi);
    Sliding of = *owner_of(function, now.t.hi);
    of.jump = mechanics_.size_of(*of.joint, now.here());
    const auto sides = find_sides(of, now, {});
    for (const auto& [each, was] : before) *each = was;
    if (sides && sides->own.margin == 0) begin(function, {.jump = of.jump}, now);
}

std::vector<Slides::Sliding>::iterator Slides::slide_of(const Piecewise& function) {
    return std::find_if(sliding_.begin(), sliding_.end(), [&](const Sliding& each) { return each.has(function); });
}

void Slides::return_to_surfaces(Now& now) const {
    for (const Sliding& each : sliding_) {
        if (each.of_place) continue;
        const Sides sides = both(each, now.here());
        double work = 0;
        if (sides.differ()) put_on_surface(each, sides, now, work);
    }
}

/// Moves all slides onto the pieces behind a break.
void Slides::renew(Now& now, std::vector<SlideChange>& changes) {
    for (const Sliding& was : std::vector<Sliding>(sliding_)) {
        sliding_.erase(slide_of(*was.function));
        if (begin(*was.function, {.jump = was.jump, .of_place = was.of_place}, now)) continue;
        was.each([](Piecewise& each) { each.let_go(); });
        was.add_changes(false, changes);
    }
}

/// Ends slides whose surface is held by contacts. The motion stays on the side into which these move it.
void Slides::end_lost(const Now& now, std::vector<SlideChange>& changes) {
    for (const Sliding& was : std::vector<Sliding>(sliding_)) {
        const Sides sides = both(was, now.here());
        if (sides.differ()) continue;
        const bool leaves = falls_if_held(was, sides.own, now.here());
        sliding_.erase(slide_of(*was.function));
        was.each([&](Piecewise& each) { each.leave(leaves ? 1 : 0); });
        left_at_ = now.t.hi, left_ = was;
        was.add_changes(false, changes);
    }
}

/// Returns the rates of y along another condition that a slide crosses: those of the mixture that stays on it, if the
/// loads move the motion across it.
std::optional<std::vector<double>> Slides::rates_along(const Piecewise& function, std::size_t condition, const Now& now,
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
        function.margins({now.t.hi + later, engine::Side::at, y}, margins);
        return margins[condition];
    };
    const double none = margin(0), whole = margin(1), more = none / (none - whole);
    if (!(std::fabs(more) <= 2)) return {};
    return with(more);
}

bool Slides::leave(Piecewise& function, std::size_t condition, Now& now, Changes& changes) {
    const auto found = slide_of(function);
    if (found == sliding_.end()) return false;
    Sliding was = *found;
    const Sides before = both(was, now.here());
    sliding_.erase(found);
    was.each([&](Piecewise& each) { changes.functions.push_back(&each); });
    if (condition > 1 && before.differ()) {  // both sides may have a new piece on which the slide continues
        const std::vector<double> rates = before.mixed();
        const auto along = rates_along(function, condition, now, before);
        if (begin(*was.function, {was.jump, was.of_place, rates}, now)) return true;
        if (along && begin(*was.function, {was.jump, false, *along}, now)) return true;
        const auto sides = decide(was, now, rates);
        if (sides) condition = sides->own.rate < 0 ? 1 : 0;
    }
    was.each([condition](Piecewise& each) { each.leave(condition); });
    if (condition <= 1) left_at_ = now.t.hi, left_ = was;
    was.add_changes(false, changes.slides);
    return true;
}

std::vector<SlideChange> Slides::end() {
    std::vector<SlideChange> changes;
    for (const Sliding& sliding : sliding_) {
        sliding.each([](Piecewise& each) { each.let_go(); });
        sliding.add_changes(false, changes);
    }
    sliding_.clear();
    return changes;
}

}  // namespace dinal::motion::engine
