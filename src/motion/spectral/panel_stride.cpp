// A feedback with very many steps, as an encoder has: from one to right behind the next in a single panel, on which M
// is a parabola through three values.
#include <algorithm>
#include <cmath>

#include "motion/spectral/edge_search.hpp"
#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

/// Where that does not go, so many panels are of the other kind.
constexpr int until_next_try = 32;

/// A way so short that four derivatives tell where it goes.
struct ShortWay {
    double velocity, first, second, third;
    [[nodiscard]] double place(double t) const {
        return t * (velocity + t * (first / 2 + t * (second / 6 + t * third / 24)));
    }
    [[nodiscard]] double speed(double t) const { return velocity + t * (first + t * (second / 2 + t * third / 6)); }

    /// When it has gone so far; `never` when it turns before, or soon.
    [[nodiscard]] double arrival(double way) const {
        const double square = velocity * velocity + 2 * first * way;
        if (!(velocity * way > 0 && square > velocity * velocity / 4)) return model::never;
        double t = 2 * way / (velocity + std::copysign(std::sqrt(square), velocity));
        for (int i = 0; i < 3; ++i) t -= (place(t) - way) / speed(t);
        return t;
    }
};

/// Through its values at 0, at half of a way and at the end of it.
Parabola through(double start, double middle, double end, double whole) {
    return {start, (4 * middle - end - 3 * start) / whole, 4 * ((start - middle) + (end - middle)) / (whole * whole)};
}

}  // namespace

/// From here to right behind the next step, if that is where it is guessed and the way there short: five values of M
/// where a panel up to it and one across take forty. What friction and springs do besides goes along as a parabola,
/// too. False when one of these or the motion is more than such a panel can be.
bool PanelSolver::stride(const Present& now, model::Motion way, const model::State& departing) {
    const bool foreseen = steps_.expected && steps_.trust > 0 && steps_.apart > 0;
    if (!foreseen || bad_time_ < model::never) return false;
    if (steps_.walks > 0) {
        --steps_.walks;
        return false;
    }
    const double t = now.clock.hi, fine = finest_edge(t), inertia = system_.inertia();
    const double widest_look = 2 * h_max_ * chebyshev::widest_gap;  // between two of the looks below: half of the way
    const double most = std::min({now.clock.until(std::min(end_of_run_, break_after(t))) / 2, 2 * widest_look,
                                  excitation_.view(t, chebyshev::widest_gap)});
    const bool same = departing.theta == now.y.theta && departing.velocity == now.y.velocity;
    const double M = now.M_sampled && same ? now.M : excitation_.value(t, departing);
    panel_.samples[0] = M;
    const auto give_up = [&, slope = steps_.slope, bend = steps_.bend] {
        steps_.slope = slope, steps_.bend = bend;
        return false;
    };
    const model::SpeedRange* friction = slide_.line();
    const double slope_of_friction = friction != nullptr ? friction->slope : 0, side = model::sign_of(way);
    const double braking = friction != nullptr ? side * friction->at(side * now.y.velocity) : system_.braking(way);
    const auto other_torque = [&](const model::State& y) {
        return (friction != nullptr ? 0 : system_.friction_remainder(way, y)) + system_.spring(y.theta);
    };
    const bool others = system_.has_remainder();
    Parabola other{others ? other_torque(now.y) : 0, steps_.other_slope, steps_.other_bend};
    constexpr int rounds = 4;
    for (int round = 0; round < rounds; ++round) {
        ShortWay ahead{};
        ahead.velocity = now.y.velocity;
        const auto acceleration = [&](double torque, double velocity, double change, double theta) {
            const double line = slope_of_friction * change;
            return (torque - system_.damping() * velocity - line - system_.stiffness() * theta) / inertia;
        };
        ahead.first = acceleration(M - braking - other.value, ahead.velocity, 0, now.y.theta);
        ahead.second = acceleration(steps_.slope - other.slope, ahead.first, ahead.first, ahead.velocity);
        ahead.third = acceleration(steps_.bend - other.bend, ahead.second, ahead.second, ahead.first);
        const double sign = ahead.velocity > 0 ? 1 : -1;
        const double place = steps_.theta + (sign == steps_.direction ? sign * steps_.apart : 0);
        const double guess = ahead.arrival(place - now.y.theta);
        if (!(guess < most)) return give_up();
        const auto state_after = [&](double since) {
            return model::State{now.y.theta + ahead.place(since), ahead.speed(since)};
        };
        const auto M_after = [&](double since) {
            return excitation_.value(now.clock.after(since), state_after(since));
        };
        double before = M, after = M;
        const auto edge = edge_near(guess, most, fine, [&](double since) {
            const double found = M_after(since);
            const bool far = is_behind_step(found, since);
            (far ? after : before) = found;
            return far;
        });
        if (!edge) return give_up();
        const double whole = edge->low, half = whole / 2, quarter = whole / 4;
        const Parabola torque = through(M, M_after(half), before, whole);
        const double M_on_the_way = M_after(quarter);
        steps_.slope = torque.slope, steps_.bend = torque.bend;
        if (others) {
            other = through(other.value, other_torque(state_after(half)), other_torque(state_after(whole)), whole);
        }
        const double end = surely_behind(*edge, {place, ahead.speed(edge->high)});
        lay(now, way, end / 2, now.clock.after(end));
        if (!follow(other)) return give_up();
        const double allowed = (tolerance_ + 4 * epsilon) * torques() + noise_;
        if (!(std::fabs(M_on_the_way - torque.at(quarter)) <= allowed)) break;
        if (others && !(std::fabs(other_torque(state_after(quarter)) - other.at(quarter)) <= allowed)) break;
        const double off = std::max(std::fabs(chebyshev::value(panel_.p, 1) - ahead.place(end)),
                                    std::fabs(chebyshev::value(panel_.v, 1) - panel_.h * ahead.speed(end)));
        if (off <= 16 * epsilon * (chebyshev::size(panel_.v) + chebyshev::size(panel_.p))) {
            steps_.stop = model::never;
            steps_.strides = true;
            steps_.other_slope = other.slope + whole * other.bend, steps_.other_bend = other.bend;
            remember_step(std::fabs(after - line(end)), *edge);
            return true;
        }
    }
    steps_.walks = until_next_try;
    return give_up();
}

}  // namespace dinal::motion::spectral
