#include "motion/engine/user_events.hpp"

#include <algorithm>
#include <cmath>

namespace dinal::motion::engine {

UserEvents::Seen UserEvents::watch(const Segment& segment, Ending& ending) {
    constexpr std::size_t most_passages = 200;
    const double before = ending.before();
    std::vector<std::pair<std::size_t, double>> wanted_ones;  // zeros that count as events
    unwanted_.clear();
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        const model::Direction direction = wanted_[e].direction;
        Watch& watch = watches_[e];
        const auto when = [&](const Moment& at) { return value(e, at); };
        Nodes values = segment.at_nodes(when, point_);
        const auto function_of_x = segment.function_of_x(when, point_);
        // Beyond a changed condition the old piece's formula, which may grow without bound, is not valid.
        const double end = ending.by == By::condition ? ending.x : 1;
        const auto place = [end](double x) { return end == 1 ? x : -1 + (x + 1) * ((end + 1) / 2); };
        const auto exact = [&](double x) { return function_of_x(place(x)); };
        if (end < 1) std::transform(cheb::nodes.begin(), cheb::nodes.end(), values.begin(), exact);
        if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); }))
            return {.good = false};
        const Watched curve(values, exact, watch.rounded);
        double from = -1;
        Half half = watch.half;
        // If the value jumps at the start, rounding may put the start before the jump.
        if (const double after = soon(segment); half * values[0] < 0 && half * exact(after) > 0) from = after;
        while (const auto x = curve.leaves(half, from)) {
            if (!(place(*x) < before)) break;
            if (watch.sent_back && !curve.is_clearly(half, *x)) return {.again = e};
            if (direction == model::Direction::both || (half < 0) == (direction == model::Direction::up)) {
                wanted_ones.emplace_back(e, place(*x));
                break;
            }
            if (unwanted_.size() > most_passages) break;
            if (watch.half == 0) watch.half = half;
            unwanted_.emplace_back(e, place(*x));
            half = -half;
            from = *x;
        }
        if (watch.half == 0) watch.half = half;
        if (watch.sent_back) watch.sent_back = !curve.is_clearly(watch.half, 1);
    }
    if (!wanted_ones.empty()) {
        double first = 1;
        for (const auto& [event, x] : wanted_ones) first = std::min(first, x);
        ending = {first, By::user};
        for (const auto& [event, x] : wanted_ones) {
            if (x <= first + one_instant) ending.users.push_back(event);
        }
    }
    return {};
}

void UserEvents::advance(double x) {
    for (const auto& [event, place] : unwanted_) {
        if (place <= x) watches_[event].half = -watches_[event].half;
    }
}

bool UserEvents::stay_clear(const Ranges& ranges) {
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        const Mechanics::UserPiece own = mechanics_.when_function(e);
        const auto range = ranges.of(own.function->read(), own.piece, mechanics_.system().named);
        if (!range || !(range->lo > 0 || range->hi < 0)) return false;
        const Half half = range->lo > 0 ? 1 : -1;
        if (watches_[e].half != 0 && watches_[e].half != half) return false;
        watches_[e].half = half, watches_[e].sent_back = false;
    }
    return true;
}

std::vector<double> UserEvents::values(const Moment& at) const {
    std::vector<double> all;
    for (std::size_t e = 0; e < watches_.size(); ++e) all.push_back(value(e, at));
    return all;
}

void UserEvents::flip_sides(const std::vector<std::size_t>& events) {
    came_from_.clear();
    for (const Watch& watch : watches_) came_from_.push_back(watch.half);
    for (const std::size_t event : events) watches_[event].half = -watches_[event].half;
}

/// Returns the change of a watched value when its arguments change by a few ulps.
double UserEvents::rounding_of(std::size_t event, const Now& now) const {
    constexpr double ulps = 1 + 4 * rounding;
    std::vector<double> y = now.y;
    const double own = value(event, {now.t.hi, now.side(), y});
    double most = 0;
    for (std::size_t k = 0; k < 2 * mechanics_.bodies(); ++k) {
        y[k] = now.y[k] * ulps;
        most = std::max(most, std::fabs(value(event, {now.t.hi, now.side(), y}) - own));
        y[k] = now.y[k];
    }
    return most;
}

/// Returns whether a value at zero continues to its new side after the user's action; otherwise the action reversed or
/// stopped it.
bool UserEvents::passes_on(std::size_t event, const Now& now, const Segment& last, double h, Balances& balances,
                           const Frame& frame) {
    constexpr double soonest = 1e-13, soon = 1e-4, few = 16, peaked = 1e-3;
    const std::size_t n = mechanics_.bodies();
    Balance found;
    if (!balances.at_present(now, frame, last, found)) return true;
    std::vector<double> rates(mechanics_.states()), y = now.y;
    mechanics_.rates(now.here(), rates.data(), &now.mode);
    const auto later = [&](double after) {
        for (std::size_t i = 0; i < n; ++i) {
            y[i] = now.y[i] + after * now.y[n + i];
            y[n + i] = now.y[n + i] + after * found.accelerations[i];
        }
        for (std::size_t k = 0; k < rates.size(); ++k) y[2 * n + k] = now.y[2 * n + k] + after * rates[k];
        return value(event, {now.t.hi + after, Side::at, y});
    };
    const double rounded = watches_[event].rounded;
    double change = later(soon * h) - later(-soon * h);
    const double bend = std::fabs(later(soon * h) + later(-soon * h) - 2 * later(0));
    if (bend > peaked * std::max(std::fabs(later(h)), std::fabs(later(-h)))) {
        // This step passes a narrow peak: takes the shortest one that changes the value clearly.
        const double clear = few * (rounded + rounding_of(event, now));
        double step = std::max(soonest * h, few * rounding * std::fabs(now.t.hi));
        change = 0;
        while (std::fabs(change) <= clear && step < soon * h) {
            change = later(step) - later(-step);
            step *= 10;
        }
    }
    return came_from_[event] * change < -rounded;
}

std::vector<std::size_t> UserEvents::passing(const Now& now, const Segment& last, double h, Balances& balances,
                                             const Frame& frame) {
    constexpr double ulps = 1 + 4 * rounding;
    std::vector<std::size_t> events;
    came_from_.clear();
    for (const Watch& watch : watches_) came_from_.push_back(watch.half);
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        const Half half = watches_[e].half;
        const bool wanted = wanted_[e].direction == model::Direction::both ||
                            (half < 0) == (wanted_[e].direction == model::Direction::up);
        if (half == 0 || !wanted) continue;
        const double own = value(e, now.here());
        const double soon = value(e, {now.t.hi * ulps, Side::at, now.y});
        const double rounded = std::fabs(soon - own) + 4 * rounding_of(e, now) + watches_[e].rounded;
        if (std::fabs(own) <= rounded && passes_on(e, now, last, h, balances, frame)) events.push_back(e);
    }
    return events;
}

void UserEvents::set_sides_after_actions(const std::vector<double>& before, const std::vector<std::size_t>& acted,
                                         const Now& now, const Segment& last, double h, Balances& balances,
                                         const Frame& frame) {
    constexpr double at_zero = 1e-12;  // smaller values relative to the stretch count as zero
    std::vector<double> begin, end;
    last.state(-1, begin), last.state(1, end);
    for (std::size_t e = 0; e < watches_.size(); ++e) {
        Watch& watch = watches_[e];
        const double own = value(e, now.here());
        const double size = std::max({std::fabs(value(e, {last.time(-1), Side::at, begin})),
                                      std::fabs(value(e, {last.end, Side::at, end})), std::fabs(own)});
        if (own == before[e]) {
            // An event taken past zero by an impact is not at zero.
            const bool stands = std::fabs(own) <= at_zero * size + 2 * rounding_of(e, now) + watch.rounded;
            if (!stands || std::find(acted.begin(), acted.end(), e) == acted.end()) continue;
            watch.rounded = 2 * std::fabs(own) + rounding_of(e, now);
            watch.sent_back = !passes_on(e, now, last, h, balances, frame);
            watch.half = watch.sent_back ? came_from_[e] : 0;
            continue;
        }
        watch.half = std::fabs(own) <= at_zero * size ? 0 : own > 0 ? 1 : -1;
        watch.sent_back = false;
    }
}

}  // namespace dinal::motion::engine
