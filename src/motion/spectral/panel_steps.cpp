// A feedback that jumps along the motion: what an encoder reads, what a relay says. Where M jumped once it is expected
// to jump again. Then each panel ends right before the next jump, which is sought along the motion that M would make if
// it went on as it is; and a short panel crosses it, with M as it was before the jump up to the jump.
#include <algorithm>
#include <cmath>
#include <optional>

#include "motion/spectral/edge_search.hpp"
#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

/// How much of the way to a jump is left for the panel that crosses it: on that M goes on as a parabola. When a jump
/// came sooner than foreseen, more is left, and the way is done in parts.
constexpr double left_over = 1e-3;
constexpr double most_left_over = 0.25;
/// At least this much, in units of pace_.
constexpr double least_left = 1e-11;
/// A jump is found to this, in units of pace_.
constexpr double located_to = 1e-15;
/// Off the straight line by this part of the jump is behind it.
constexpr double behind = 0.125;
/// After so many panels without a jump none is expected any more.
constexpr int most_quiet = 32;
/// So many jumps are sought, not guessed, after a guess was wrong.
constexpr int wary = 8;
/// To where the next jump is guessed, in ways from one to the next, a panel may reach.
constexpr double reaches = 1.5;
/// A jump is at least this part of the torques.
constexpr double least_jump = 1e-9;
/// What M bends by between nodes is smooth when the last coefficients of its series are below this part of it.
constexpr double smooth = 1e-3;
constexpr std::size_t most_in_a_panel = 4;

}  // namespace

/// A panel was not resolved by far, although M is finite: perhaps it jumps.
void PanelSolver::missed_step() {
    if (!feedback_ || panel_.motion == model::Motion::stuck) return;
    steps_.expected = true;
    steps_.quiet = 0;
    constexpr double most = most_left_over / left_over;
    if (steps_.stop < model::never && steps_.part < most) {
        steps_.part = std::min(8 * steps_.part, most);
    } else if (steps_.guessed) {
        steps_.trust = -wary;
    }
    steps_.stop = model::never;
}

/// How M goes on from the panel before, if that ended here.
void PanelSolver::go_on_from(const Present& now, model::Motion way) {
    const bool follows = panel_.h > 0 && std::fabs(now.clock.until(panel_.end)) <= 8 * epsilon * std::fabs(panel_.end);
    steps_.slope = steps_.bend = 0;
    if (!follows || panel_.motion != way) return;
    const auto& [first, second, third] = chebyshev::derivative_bounds<points>;  // what they are at the end
    for (std::size_t k = 1; k < points; ++k) {
        steps_.slope += first[k] * panel_.M[k];
        steps_.bend += second[k] * panel_.M[k];
    }
    steps_.slope /= panel_.h, steps_.bend /= panel_.h * panel_.h;
}

/// M since the beginning of the panel, if it goes on so.
double PanelSolver::line(double since) const {
    return Parabola{panel_.samples[0], steps_.slope, steps_.bend}.at(since);
}

/// How well the time of a jump can be known.
double PanelSolver::finest_edge(double t) const {
    return std::max(located_to * pace_, 4 * epsilon * std::fabs(t));
}

/// Whether this value of M is none of those before the jump.
bool PanelSolver::is_behind_step(double M, double since) const {
    return std::fabs(M - line(since)) > behind * steps_.jump;
}

/// When theta is behind a jump however it is rounded.
double PanelSolver::surely_behind(const Edge& edge, const model::State& there) {
    const double rounded = 4 * epsilon * std::fabs(there.theta / there.velocity), most = 4 * (edge.high - edge.low);
    return edge.high + (rounded < most ? rounded : most);  // at theta = 0 and velocity 0 it is no number
}

/// The motion on the panel if M goes on so.
bool PanelSolver::predict(const model::State& departing) {
    panel_.samples[0] = sampled(0, departing);
    return std::isfinite(panel_.samples[0]) && follow_line();
}

bool PanelSolver::follow_line() {
    if (!system_.has_remainder()) return follow({});
    Parabola other{remainder(panel_.begin)};
    if (!follow(other)) return false;
    other.slope = (remainder(state_at(1)) - other.value) / panel_.length;
    return follow(other);
}

/// The motion if M goes on so, less what friction and springs do besides.
bool PanelSolver::follow(const Parabola& other) {
    falls_.theta = falls_.velocity = 0;
    const double h = panel_.h;
    const auto series = [h](const Parabola& y) {
        const double bend = y.bend * h * h;
        Series sum{};
        sum[0] = y.value + y.slope * h + bend * 3 / 4;
        sum[1] = y.slope * h + bend;
        sum[2] = bend / 4;
        return sum;
    };
    panel_.M = series({panel_.samples[0], steps_.slope, steps_.bend});
    Series torque = panel_.M;
    if (system_.has_remainder()) {
        const Series less = series(other);
        for (std::size_t k = 0; k < 3; ++k) torque[k] -= less[k];
    }
    solve_for(torque);
    return std::isfinite(torque[0]) && within_range();
}

/// Where the motion goes on the panel: 1 forward, -1 backward.
double PanelSolver::direction() const {
    const double first = panel_.begin.velocity;
    return (first != 0 ? first : chebyshev::value(panel_.p, 1)) > 0 ? 1 : -1;
}

model::State PanelSolver::state_at(double x) const {
    return {panel_.begin.theta + chebyshev::value(panel_.p, x), chebyshev::value(panel_.v, x) / panel_.h};
}

/// When the motion comes to the place of the next jump, if these are evenly spaced: time units after the beginning of
/// the panel; `never` when it does not on this panel.
double PanelSolver::guessed_step() const {
    const double sign = direction();
    const double place = steps_.theta + (sign == steps_.direction ? sign * steps_.apart : 0);
    const double way = sign * (place - panel_.begin.theta);
    const auto passed = [&](double x) { return sign * chebyshev::value(panel_.p, x) - way; };
    if (!(way > 0) || !(passed(1) > 0)) return model::never;
    double a = -1, b = 1, x = 0;
    for (int i = 0; i < 100 && b - a > epsilon; ++i) {  // Newton's, within the bracket
        const double off = passed(x);
        (off > 0 ? b : a) = x;
        const double next = x - off / (sign * chebyshev::value(panel_.v, x));
        const double before = x;
        x = next > a && next < b ? next : a + (b - a) / 2;
        if (std::fabs(x - before) <= epsilon) break;
    }
    return panel_.h * (1 + x);
}

/// The first jump along the predicted motion, on which M is asked at the nodes: time units after the beginning of the
/// panel; `never` when there is none, 0 when there are so many that a shorter panel must tell.
double PanelSolver::sought_step() {
    const auto p = chebyshev::at_nodes(panel_.p), v = chebyshev::at_nodes(panel_.v);
    auto& M = panel_.samples;
    for (std::size_t j = 1; j < points; ++j) {
        M[j] = sampled(j, {panel_.begin.theta + p[j], v[j] / panel_.h});
        if (!std::isfinite(M[j])) return model::never;
    }
    steps_.sampled = true;
    panel_.M = chebyshev::fit(M);
    const double tail = chebyshev::tail(panel_.M);
    if (!(tail > least_jump * torques())) return model::never;
    // Between most nodes there is no jump, and M goes on with the middle one of its slopes.
    std::array<double, points - 1> slopes{}, sorted{};
    for (std::size_t j = 0; j + 1 < points; ++j) {
        slopes[j] = (M[j + 1] - M[j]) / (panel_.h * (chebyshev::nodes[j + 1] - chebyshev::nodes[j]));
    }
    sorted = slopes;
    auto* const middle = sorted.begin() + sorted.size() / 2;
    std::nth_element(sorted.begin(), middle, sorted.end());
    const double slope = *middle;
    const auto since = [&](std::size_t j) { return panel_.h * (1 + chebyshev::nodes[j]); };
    const auto off = [&](std::size_t j) { return std::fabs(M[j + 1] - M[j] - slope * (since(j + 1) - since(j))); };
    double most = 0;
    for (std::size_t j = 0; j + 1 < points; ++j) most = std::max(most, off(j));
    if (tail <= smooth * most) return model::never;
    std::size_t first = points, count = 0;
    for (std::size_t j = 0; j + 1 < points; ++j) {
        if (off(j) < most / 4) continue;
        first = std::min(first, j);
        ++count;
    }
    if (count > most_in_a_panel) return 0;
    double low = since(first), high = since(first + 1), value_low = M[first], value_high = M[first + 1];
    while (high - low > left_over / 4 * high && high - low > located_to * pace_) {
        const double middle_time = low + (high - low) / 2;
        const double value = excitation_.value(panel_.start.after(middle_time), state_at(middle_time / panel_.h - 1));
        const bool before = std::fabs(value - M[first] - slope * (middle_time - since(first))) <= behind * most;
        (before ? low : high) = middle_time;
        (before ? value_low : value_high) = value;
    }
    // What is steep, and not a jump, has become less.
    if (!(std::fabs(value_high - value_low) > behind / 2 * most)) return model::never;
    steps_.jump = std::fabs(value_high - value_low);
    return high;
}

/// Chooses a panel that ends before the next jump of M, as far as that can be foreseen. False when there are too many.
bool PanelSolver::foresee(const Present& now, model::Motion way, const model::State& departing) {
    steps_.stop = model::never;
    steps_.sampled = steps_.predicted = steps_.guessed = false;
    // Very short panels may have passed jumps that were too low to be seen on them.
    const bool long_ago = now.clock.hi - steps_.last > most_quiet * steps_.spacing;
    if (steps_.expected && ++steps_.quiet > most_quiet && long_ago) steps_.expected = false;
    if (steps_.expected && steps_.spacing > 0) {
        h_ = std::min(h_, std::ldexp(reaches / 2 * steps_.spacing, steps_.quiet - 1));
    }
    choose(now, way);
    if (!steps_.expected || !predict(departing)) return true;
    steps_.predicted = true;
    steps_.guessed = steps_.apart > 0 && steps_.trust >= 0;
    const double ahead = steps_.guessed ? guessed_step() : sought_step();
    if (ahead == 0) return false;
    if (!(ahead < panel_.length)) return true;
    steps_.left = std::max(steps_.part * left_over * ahead, least_left * pace_);
    if (ahead <= 2 * steps_.left) {
        steps_.stop = now.clock.hi;  // it is right here
        return true;
    }
    steps_.stop = now.clock.after(ahead - steps_.left);
    h_ = panel_.h;
    choose(now, way);
    steps_.sampled = false;
    steps_.predicted = predict(departing);
    return true;
}

/// A jump is right ahead: a short panel up to behind it. False when there is none.
bool PanelSolver::cross_step(const Present& now, model::Motion way, const model::State& departing) {
    const double t = now.clock.hi,
                 most = std::min(4 * steps_.left, now.clock.until(std::min(end_of_run_, break_after(t))) / 2);
    steps_.stop = model::never;
    steps_.predicted = steps_.sampled = false;
    if (!(most > 0)) return false;
    lay(now, way, most / 2, now.clock.after(most));
    if (!predict(departing)) return false;
    double value = 0, off = 0;  // behind it, and how far before it M is off the line
    const auto is_behind = [&](double since) {
        const double found = excitation_.value(panel_.start.after(since), state_at(since / panel_.h - 1));
        const bool far = is_behind_step(found, since);
        if (far) {
            value = found;
        } else {
            off = std::fabs(found - line(since));
        }
        return far;
    };
    const double fine = finest_edge(t);
    std::optional<Edge> edge;
    if (steps_.guessed) edge = edge_near(guessed_step(), most, fine, is_behind);
    if (!edge) steps_.ways = 0;
    if (!edge && is_behind(most)) edge = narrowed({0, most}, fine, is_behind);
    if (!edge) {
        if (steps_.guessed) steps_.trust = -wary;
        return false;
    }
    if (off > behind / 2 * steps_.jump) return false;  // steep, and no jump: M was on its way before
    const double end = surely_behind(*edge, state_at(edge->high / panel_.h - 1));
    lay(now, way, end / 2, now.clock.after(end));
    if (!predict(departing)) return false;
    remember_step(std::fabs(value - line(end)), *edge);
    return true;
}

void PanelSolver::remember_step(double jump, const Edge& edge) {
    const double theta = state_at(edge.middle() / panel_.h - 1).theta;
    if (direction() == steps_.direction) {
        // The mean of many ways, each of which is known as well as the times of two jumps.
        constexpr int most_ways = 64;
        steps_.ways = std::min(steps_.ways + 1, most_ways);
        steps_.apart += (std::fabs(theta - steps_.theta) - steps_.apart) / steps_.ways;
    }
    if (steps_.last > -model::never) steps_.spacing = panel_.end - steps_.last;
    ++steps_.trust, ++steps_.count;
    steps_.theta = theta, steps_.direction = direction(), steps_.jump = jump, steps_.last = panel_.end;
    steps_.quiet = 0;
    h_ = std::min(h_max_, std::max(h_, reaches / 2 * steps_.spacing));  // it became short on the way here
}

}  // namespace dinal::motion::spectral
