#include "motion/engine/recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/engine/crossing.hpp"
#include "motion/engine/walls.hpp"
#include "motion/first_below.hpp"

namespace dinal::motion::engine {

using model::Event;
using model::EventKind;
using model::Joint;
using model::Motion;

Recorder::Recorder(const Request& problem, const Mechanics& mechanics, Run& result, const Now& start, double unit)
    : problem_(problem),
      mechanics_(mechanics),
      result_(result),
      unit_(unit),
      heading_(mechanics.bodies(), Motion::stuck) {
    std::vector<Joint> weights;
    for (const Joint& joint : problem.system.joints) {
        weights.push_back({.name = {}, .of = joint.of, .damping = joint.damping, .stops = joint.stops});
    }
    history_ = std::make_shared<History>(std::move(weights), n(), start.y, start.t.hi,
                                         problem.before ? problem.before->past : nullptr, problem.history_bytes);
    const std::size_t columns = 1 + columns_of_body * n() + columns_of_link * (problem_.own_joints() - n()) +
                                problem.hidden + mechanics.states_of_user() + (problem.joined_elsewhere ? 0 : n());
    Growing<double> table(problem.rows.count(), columns);
    cells_ = table.writable_values();
    result.rows = Rows(std::move(table));
}

void Recorder::report_user_event(const Now& now, std::size_t event) {
    for (std::size_t j = 0; j < problem_.own_joints(); ++j) {
        report_event(now, EventKind::user, j, static_cast<int>(event));
    }
}

void Recorder::report_event(const Reported& reported) {
    constexpr double clearly_later = 1e-3;
    const Event& event = reported.event;
    if (reported.holds_again && withdraw(EventKind::slip, static_cast<std::size_t>(event.where), event.t)) return;
    if (contact::only_touched(recent_, {event, reported.slid, reported.way, reported.off, reported.size}, unit_))
        return;
    if (!recent_.empty() && event.t - recent_.back().t > clearly_later * unit_) write_recent();
    recent_.push_back(event);
}

void Recorder::write_recent() {
    events_.insert(events_.end(), recent_.begin(), recent_.end());
    recent_.clear();
}

void Recorder::report_slide(const Now& now, const SlideChange& change) {
    if (!(now.t.hi > problem_.window.start)) return;
    const auto [own, other] = change.begins ? std::pair(EventKind::slide_begins, EventKind::slide_ends)
                                            : std::pair(EventKind::slide_ends, EventKind::slide_begins);
    for (std::size_t j = 0; j < problem_.own_joints(); ++j) {
        if (change.joint && *change.joint != j) continue;
        if (!withdraw(other, j, now.t.hi)) report_event(now, own, j);
    }
}

/// Withdraws an event of this kind at this time. Returns whether there was one.
bool Recorder::withdraw(EventKind kind, std::size_t joint, double t) {
    const auto found = std::find_if(recent_.rbegin(), recent_.rend(), [&](const Event& e) {
        return e.where == static_cast<int>(joint) && e.kind == kind && e.t == t;
    });
    if (found == recent_.rend()) return false;
    recent_.erase(std::next(found).base());
    return true;
}

/// Removes all but the first of stops and slips that followed one another without progress. At a regular end a creep is
/// recorded as a stick; at rest the last stick becomes a rest.
void Recorder::end_events(model::Outcome outcome, const Mode& mode, const Contacts& contacts) {
    constexpr double soon = 1e-6;
    const auto follows = [&](const Event& e, const Event& before) {
        return e.kind <= EventKind::rest && e.t - before.t <= soon * unit_;
    };
    while (outcome == model::Outcome::chattering && recent_.size() > 1 &&
           follows(recent_.back(), *(recent_.end() - 2))) {
        recent_.pop_back();
    }
    write_recent();
    for (std::size_t j = 0; j < mechanics_.joints() && model::is_whole(outcome); ++j) {
        if (mode.friction[j].creeps == Motion::stuck) continue;
        const Event& event = contacts.of[j].creeping;
        const auto later = std::upper_bound(events_.begin(), events_.end(), event,
                                            [](const Event& a, const Event& b) { return a.t < b.t; });
        events_.insert(later, event);
    }
    if (outcome != model::Outcome::at_rest) return;
    const auto last =
        std::find_if(events_.rbegin(), events_.rend(), [](const Event& e) { return e.kind == EventKind::stick; });
    if (last != events_.rend()) last->kind = EventKind::rest;
}

void Recorder::record_turns(const Stretch& of, double until, const TorqueSizes& sizes, double noise) {
    const auto& [now, segment, frame, balances, sampled] = of;
    std::vector<Event>& turns = room_.turns;
    turns.clear(), room_.rubs.assign(n(), 0);
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) {
        if (!now.rubs(j)) continue;
        for (const model::Weight& weight : problem_.system.joints[j].of) room_.rubs[weight.body] = 1;
    }
    for (std::size_t i = 0; i < n(); ++i) {
        if (room_.rubs[i] == 0 && !frame.bodies[i].empty()) {
            const double torques = std::max(100 * rounding * sizes.on(problem_.system.joints[i]), noise);
            record_turns(i, segment, until, segment.h / problem_.system.bodies[i].inertia * torques, sampled, turns);
        }
    }
    const auto earlier = [](const Event& a, const Event& b) { return a.t < b.t; };
    if (turns.size() > 1) std::stable_sort(turns.begin(), turns.end(), earlier);
    for (const Event& turn : turns) report_event({.event = turn});
}

void Recorder::record_turns(std::size_t body, const Segment& segment, double until, double nothing,
                            SampledLoads& sampled, std::vector<Event>& turns) {
    const Nodes& v = segment.y[n() + body];
    const double moving = greatest(v);
    const auto exact = [&](double x) { return segment.at(n() + body, x); };
    constexpr double underflow = 1e-280;  // smaller numbers lose digits
    if (!(moving > std::max(nothing, underflow))) return;
    Half half = static_cast<int>(heading_[body]);
    Series series = segment.series[n() + body];
    series[0] += v[0];
    if (half != 0 && stays_above_zero(half, series)) return;
    const Watched watched(v, exact, 0, series);
    std::vector<double>& zeros = room_.zeros;
    zeros.assign(1, -1);
    const cheb::Series<node_count - 1> slope = cheb::derivative(series);
    // Searches the next zero by the series if the velocity is clearly nonzero first, or has crossed zero with a slope.
    const auto next_zero = [&]() -> std::optional<double> {
        const double from = zeros.back();
        Nodes values = v;
        for (double& each : values) each *= half;
        const cheb::Bounded<node_count> curve(half, series, slope, values);
        const double rate = from > -1 ? std::max(0.0, curve.slope(from)) : 0, far = rate / curve.second_bound();
        const double clear = from > -1 ? rate * far / 2 : values[0];
        if (half == 0 || !(clear > 4 * curve.floor()) || !(cheb::tail(series) <= 1e-9 * moving))
            return watched.leaves(half, zeros.back());
        return cheb::first_below(curve, std::min(1.0, from > -1 ? from + far : from));
    };
    for (;;) {
        const auto x = next_zero();
        if (!x || *x >= until - 1e-12) break;
        zeros.push_back(*x);
        half = -half;
    }
    // Between two zeros the velocity may be only the error of a series that fits the motion before or after.
    const auto moves = [&](std::size_t k) {
        const double from = zeros[k], to = k + 1 < zeros.size() ? zeros[k + 1] : until;
        const double least = 8 * problem_.tolerance * moving;
        for (std::size_t j = 0; j < node_count; ++j) {
            if (cheb::nodes[j] > from && cheb::nodes[j] < to && std::fabs(v[j]) > least) return true;
        }
        return std::fabs(exact((from + to) / 2)) > least;
    };
    int way = static_cast<int>(heading_[body]);
    bool moved = false;  // whether the body has moved on the stretch
    for (std::size_t k = 0; k < zeros.size(); ++k) {
        const int next = (zeros.size() - 1 - k) % 2 == 0 ? half : -half;
        const bool clear = moves(k), at_end = k + 1 == zeros.size() && moved;
        moved = moved || clear;
        if (next == way || !(clear || at_end)) continue;
        if (std::exchange(way, next) == 0) continue;
        const double x = zeros[k], t = segment.time(x);
        if (!(t > problem_.window.start) && problem_.before == nullptr) continue;
        std::vector<double>& y = room_.y;
        segment.state(x, y);
        const std::optional<double> known = sampled.at(body, x);
        const double M = known ? *known : mechanics_.load(body, {t, Side::at, y});
        turns.push_back({.t = t, .theta = y[body], .M = M, .where = static_cast<int>(body)});
    }
    heading_[body] = static_cast<Motion>(way);
}

bool Recorder::rows_until(const Stretch& of, double end, bool to_the_end) {
    const Grid& rows = problem_.rows;
    while (next_row_ < rows.count()) {
        const double t = rows.time(next_row_);
        if (!(t < end) && !(to_the_end && t < of.segment.end)) return true;
        if (!put_row(of, t, std::clamp(of.segment.start.until(t) / of.segment.h - 1, -1.0, 1.0))) return false;
    }
    return true;
}

void Recorder::put_row(double t, const model::State& y, double M, double friction, std::span<const double> states) {
    double* cell = cells_ + next_row_;
    const std::size_t stride = problem_.rows.count();
    const AtRow at{t, y, M, friction, problem_.system.joints[0].damping};
    const auto put = [&](double value) {
        *cell = value == 0 ? 0 : value;
        cell += stride;
    };
    for_each_column<body_columns>([&](std::size_t /*c*/, auto value) { put(value(at)); });
    std::for_each(states.begin(), states.end(), put);
    const double all = M + friction + column::damping.value(at) - problem_.system.joints[0].stiffness * y.theta;
    if (!problem_.joined_elsewhere) put(all / problem_.system.bodies[0].inertia);
    ++next_row_;
}

bool Recorder::rows_at_end(const Stretch& of) {
    const double t = of.now.t.hi;
    while (next_row_ < problem_.rows.count() && problem_.rows.time(next_row_) <= t) {
        if (!put_row(of, t, -2)) return false;
    }
    return true;
}

bool Recorder::put_row(const Stretch& of, double t, double x) {
    const auto& [now, segment, frame, balances, sampled] = of;
    std::vector<double>& y = row_;
    y = now.y;
    if (x > -1) segment.state(x, y);
    Walls::keep_within(problem_.system, y);
    const Moment at{t, x <= -1 ? now.side() : Side::at, y};
    bool needs_look = !problem_.joined_elsewhere;
    for (std::size_t j = 0; j < mechanics_.joints(); ++j) needs_look = needs_look || now.mode.holds(j);
    if (needs_look && x > -1 && !balances.on_stretch(segment, x, at, now.mode, frame, balance_, &sampled)) return false;
    if (needs_look && !(x > -1) && !balances.at_present(at, now, now.mode, frame, segment, balance_)) return false;
    double* cell = cells_ + next_row_;
    const std::size_t stride = problem_.rows.count();
    const auto put = [&](double value) {
        *cell = value == 0 ? 0 : value;
        cell += stride;
        return std::isfinite(value);
    };
    bool good = put(t);
    AtRow row{.t = t};
    const auto put_column = [&](std::size_t c, auto value) { good = (c == 0 || put(value(row))) && good; };
    for (std::size_t i = 0; i < n(); ++i) {
        const std::optional<double> known = sampled.at(i, x);
        row.y = {y[i], y[n() + i]};
        row.torque = known ? *known : mechanics_.load(i, at);
        const double by_load = held_by_load(now, i, at, balance_);
        row.torque += by_load, row.friction = friction(now, i, at, balance_) - by_load;
        row.damping = problem_.system.joints[i].damping;
        for_each_column<body_columns>(put_column);
    }
    for (std::size_t j = n(); j < problem_.own_joints(); ++j) {
        const double belt = mechanics_.belt(j, t, at.side);
        double torque = -mechanics_.joint_torque(j, at, now.mode, belt);
        if (!mechanics_.loads()[j].none()) torque += mechanics_.load(j, at);
        if (now.mode.holds(j)) torque += balance_.holding[j];
        const bool kept = now.mode.rigid[j] != 0;  // rigid joints keep their angle exactly
        row.y = {kept ? now.rigid_at[j] : mechanics_.angle(j, y), kept ? 0 : mechanics_.velocity(j, y)};
        row.torque = torque;
        row.friction = friction(now, j, at, balance_) - held_by_load(now, j, at, balance_);
        row.damping = problem_.system.joints[j].damping;
        for_each_column<link_columns>(put_column);
    }
    for (std::size_t j = problem_.own_joints(); j < mechanics_.joints(); ++j) {
        const std::size_t body = problem_.moved_body(j);
        const double more = mechanics_.own_inertia(body) - problem_.system.bodies[body].inertia;
        good = put(balance_.holding[j] + more * balance_.accelerations[body]) && good;
    }
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) good = put(y[2 * n() + k]) && good;
    for (std::size_t i = 0; i < n() && !problem_.joined_elsewhere; ++i) good = put(balance_.accelerations[i]) && good;
    if (good) ++next_row_;
    return good;
}

/// The friction torque of a joint on its first body.
double Recorder::friction(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const {
    // A wall carries the load that presses against it, friction the load that pulls away from it.
    if (now.rubs(joint) && now.mode.friction[joint].way == Motion::stuck) {
        const double held = balance.holding[joint] - mechanics_.slider_torque(joint, at.y);
        return now.mode.leans[joint] != 0 && now.mode.leans[joint] * held <= 0 ? 0.0 : held;
    }
    return mechanics_.friction(joint, at, now.mode, mechanics_.belt(joint, at.t, at.side));
}

/// Returns the part of a joint's holding torque that exceeds the limit of friction. If the load jumps there, it has a
/// value between both sides and supplies this part.
double Recorder::held_by_load(const Now& now, std::size_t joint, const Moment& at, const Balance& balance) const {
    if (!now.mode.holds(joint) || now.mode.friction[joint].beside == 0) return 0;
    const double held = balance.holding[joint];
    const double most = mechanics_.holding(joint, held > 0 ? Motion::backward : Motion::forward, at);
    return std::fabs(held) > most ? held - std::copysign(most, held) : 0;
}

void Recorder::keep(const Now& now, const Segment& segment, double length, double longest_delay) {
    if (!(length > 0) || (!problem_.limits.dense && longest_delay == 0)) return;
    Kept kept{.start = segment.start, .h = segment.h, .length = length};
    kept.y.reserve(now.y.size());
    for (std::size_t k = 0; k < now.y.size(); ++k) kept.y.push_back({now.y[k], segment.series[k]});
    // The torques are needed for the legs of the course.
    if (problem_.limits.dense && problem_.keeps_torques) kept.acting = acting(now, segment);
    const double past = longest_delay > 0 ? now.t.hi - 2 * longest_delay : model::never;
    history_->add(std::move(kept), problem_.limits.dense, past);
}

void Recorder::finish(const Now& now, const Contacts& contacts, std::shared_ptr<const Carry> carry) {
    if (next_row_ < problem_.rows.count()) result_.rows = Rows(result_.rows.table().first(next_row_));
    end_events(result_.outcome, now.mode, contacts);
    result_.events = Growing<Event>(std::move(events_));
    history_->close(now.t, now.y);
    left_->history = history_;
    left_->carry = std::move(carry);
    result_.left = std::move(left_);
}

/// Returns the torques at each joint over the stretch.
std::vector<Kept::JointTorques> Recorder::acting(const Now& now, const Segment& segment) {
    std::vector<Kept::JointTorques> all(mechanics_.joints());
    for (std::size_t j = 0; j < all.size(); ++j) {
        all[j].M = segment.driven[j];
        // Functions of the motion were last evaluated before the final step of the iteration.
        for (std::size_t node = 0; node < node_count && mechanics_.loads()[j].depends_on_motion(); ++node) {
            all[j].M[node] = segment.loads[j][node] + mechanics_.loads()[j].of_motion(segment.moment(node, point_));
        }
        if (j < n()) {
            if (mechanics_.has_base()) all[j].push = std::make_unique<Nodes>();
            for (std::size_t node = 0; node < node_count && mechanics_.has_base(); ++node) {
                double& push = (*all[j].push)[node];
                push = -problem_.system.bodies[j].inertia * mechanics_.base(segment.times[node], segment.side(node));
                all[j].M[node] -= push;
            }
        }
        all[j].holds = now.rubs(j) && now.mode.leans[j] == 0 && now.mode.friction[j].way == Motion::stuck;
        if (j >= problem_.own_joints()) {  // the torque that moves a prescribed body counts as its input
            const std::size_t body = problem_.moved_body(j);
            const double more = mechanics_.own_inertia(body) - problem_.system.bodies[body].inertia;
            for (std::size_t node = 0; node < node_count; ++node) {
                all[body].M[node] += segment.holding[j][node] + more * segment.f[n() + body][node];
            }
            continue;
        }
        add_springs(now, segment, j, all[j]);
        if (mechanics_.has_belt(j)) all[j].belt = std::make_unique<Nodes>(segment.belts[j]);
        add_friction(now, segment, j, all[j]);
    }
    return all;
}

/// Adds the torques of sticking sliders' springs and pressed walls, which store energy.
void Recorder::add_springs(const Now& now, const Segment& segment, std::size_t joint,
                           Kept::JointTorques& acting) const {
    acting.presses = now.mode.presses[joint] != 0;
    if (!acting.presses && now.mode.sliders.empty()) return;
    Nodes springs{};
    if (acting.presses) {
        const model::Walls& stops = *problem_.system.joints[joint].stops;
        springs = mechanics_.between(joint, segment.y);
        for (double& q : springs) q = stops.torque(now.mode.presses[joint], q, 0);
    }
    for (std::size_t s = 0; s < now.mode.sliders.size(); ++s) {
        const Mechanics::Slider& slider = mechanics_.sliders()[s];
        if (slider.joint != joint) continue;
        if (now.mode.sliders[s] == Motion::stuck) {
            add(springs, segment.y[slider.bend], slider.stiffness);
        } else {
            acting.slides += slider.stiffness * segment.y[slider.bend][0];
        }
    }
    if (greatest(springs) > 0) acting.springs = std::make_unique<Nodes>(springs);
}

void Recorder::add_friction(const Now& now, const Segment& segment, std::size_t joint, Kept::JointTorques& acting) {
    if (acting.holds) {
        acting.friction = segment.holding[joint];
    } else if (mechanics_.is_native(joint) && now.rubs(joint) && now.mode.leans[joint] == 0) {
        const bool by_speed = problem_.system.joints[joint].friction.law.depends_on_speed();
        const Nodes slips = by_speed ? mechanics_.slips(joint, segment.y, segment.belts[joint]) : Nodes{};
        mechanics_.add_native_friction(joint, now.mode, slips, 0, node_count, acting.friction);
        for (double& torque : acting.friction) torque = -torque;
    } else if (now.rubs(joint) || mechanics_.bristle(joint) != nullptr) {
        for (std::size_t node = 0; node < node_count; ++node) {
            const Moment at = segment.moment(node, point_);
            acting.friction[node] = mechanics_.friction(joint, at, now.mode, segment.belts[joint][node]) +
                                    mechanics_.slider_torque(joint, at.y);
        }
    }
}

}  // namespace dinal::motion::engine
