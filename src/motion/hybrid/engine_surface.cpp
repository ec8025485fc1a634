// Where a mass comes to rest on its surface, creeps there, is let go, or turns.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/hybrid/engine.hpp"

namespace dinal::motion::hybrid {

/// Whether a step of Runge-Kutta goes one way by what is known at its ends. A jump of M at one of them bends the curve
/// between them further than the motion goes.
bool Engine::keeps_its_way() const {
    const std::size_t end = node_count - 1;
    const double way = model::sign_of(standstill_.motion());
    const auto slip = [&](const Nodes& mass, const Nodes& surface, std::size_t j) {
        return way * (mass[j] - surface[j]);
    };
    const double a0 = slip(piece_.f[1], piece_.belt_rate, 0), a1 = slip(piece_.f[1], piece_.belt_rate, end);
    const bool leaves = standstill_.phase() != Standstill::Phase::leaving || a0 > 0;
    return leaves && slip(piece_.y[1], piece_.belt, end) > 0 && !(a0 < 0 && a1 > 0);
}

/// Where the closed form of a held piece has its first zero of the velocity, refined on its series; 2 when nowhere.
/// None where rounding has a say in it.
std::optional<double> Engine::turn_of_held(const Series& velocity) const {
    if (!piece_.held) return {};
    constexpr double clearly = 1e-6, at_rest = 1e-9;
    const double way = model::sign_of(standstill_.motion()), fastest = greatest(piece_.y[1]), a = piece_.f[1][0];
    const double torques =
        std::fabs(piece_.M[0]) + system_.greatest_holding() + system_.stiffness() * std::fabs(theta());
    const bool under_way = way * y_[1] > at_rest * fastest;
    if (!under_way && !(y_[1] == 0 && way * a * system_.inertia() > at_rest * torques)) return {};
    const double tau = solver_.free().turns_after(y_[1], a);
    if (tau > 2 * piece_.h * (1 + clearly)) {
        return way * piece_.y[1][node_count - 1] > at_rest * fastest ? std::optional(2.0) : std::nullopt;
    }
    const double guess = tau / piece_.h - 1;
    if (!(guess > -1 + clearly && guess < 1 - clearly)) return {};
    double x = guess, slope = 0;
    for (int i = 0; i < 2; ++i) {
        slope = cheb::value(cheb::derivative(velocity), x);
        x -= cheb::value(velocity, x) / slope;
    }
    if (!(way * slope < -clearly * fastest && std::fabs(x - guess) < clearly)) return {};
    return x;
}

Series Engine::slip_series() const {
    Series slip = piece_.series[1];
    slip[0] += y_[1];
    if (!field_.has_belt()) return slip;
    const Series belt = cheb::fit(piece_.belt);
    for (std::size_t k = 0; k < slip.size(); ++k) slip[k] -= belt[k];
    return slip;
}

/// How long a piece may be under a law of friction that names its corners.
double Engine::longest_under_friction() const {
    const model::Slide& slide = solver_.slide();
    if (!slide.inside()) return model::never;
    const double sign = model::sign_of(standstill_.motion()), I = system_.inertia(), C = system_.damping();
    const double first = acceleration() - field_.belt_slope(now_.hi).rate;
    const double second = (std::fabs(system_.stiffness() * y_[1]) + std::fabs(C * first)) / I;
    return slide.longest_step(sign * (y_[1] - belt()), sign * first, second, C, I);
}

/// Where friction turns a corner.
std::optional<spectral::CornerWatch::Corner> Engine::first_corner(double until) const {
    const Series slip = slip_series();
    const auto slope = cheb::derivative(slip);
    const double rounded = 16 * rounding * (greatest(piece_.y[1]) + greatest(piece_.belt));
    return corners_.first<node_count>({model::sign_of(standstill_.motion()), slip, slope, 1, rounded, 0}, until);
}

/// The piece has ended at a corner, and the speed is that of the corner.
void Engine::go_over(const spectral::CornerWatch::Corner& corner) {
    y_[1] = belt() + model::sign_of(standstill_.motion()) * corner.speed;
    standstill_.go_on();
}

/// Where the mass is as fast as its surface. At the end of the piece, zero within rounding is zero.
std::optional<double> Engine::first_standstill() const {
    using namespace spectral::chebyshev;
    if (cut_.h > 0 && keeps_its_way()) return {};
    if (const model::Slide& slide = solver_.slide(); slide.inside() && slide.range().from > 0) return {};
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    const Series slip = slip_series();
    const double fastest = greatest(piece_.y[1]) + greatest(piece_.belt);
    if (!leaving && stays_above_zero(model::sign_of(standstill_.motion()), slip, fastest)) return {};
    if (const auto x = turn_of_held(slip)) return *x < 1 ? x : std::nullopt;
    const double torques = greatest(piece_.M) + greatest(piece_.push) + system_.greatest_holding() +
                           system_.stiffness() * (greatest(piece_.y[0]) + std::fabs(origin_)) +
                           std::fabs(system_.spring(theta()));
    Bounded<points> curve(model::sign_of(standstill_.motion()), slip, derivative(slip));
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
    // Along a mass at a wall a belt slides one way on a piece; where it begins or ends with zero, rounding does not
    // say.
    const double drags = piece_.belt[node_count / 2] < 0 ? -1 : 1, slowest = std::numeric_limits<double>::min();
    const bool dragged = piece_.leans && piece_.belt[node_count / 2] != 0;
    const auto pull_at = [&](double M, double push, double rate, double belt) {
        if (dragged) belt = drags * std::max(drags * belt, slowest);
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
    // Near its zero a belt is rounded as it is elsewhere, and at a late time as that is.
    const double late = std::max(std::fabs(piece_.start.hi), std::fabs(piece_.end));
    const double fastest = std::max(solver_.fastest_belt(), late * greatest(piece_.belt_rate));
    const double rounded_rate = 256 * rounding * fastest / piece_.h;
    const Series belt = fit(piece_.belt), rate = fit(piece_.belt_rate);
    for (const model::Motion side : {model::Motion::forward, model::Motion::backward}) {
        if (side == standstill_.leans()) continue;
        const double sign = model::sign_of(side), limit = standstill_.limit(side);
        Series left{};
        for (std::size_t k = 0; k < points; ++k) left[k] = -sign * pull[k];
        left[0] += limit;
        if (held) left[0] += clearly_beyond;
        Bounded<points> curve(1, left, derivative(left));
        const double doubt = 8 * (rounding * (std::fabs(limit) + largest) + tail(pull)) +
                             system_.inertia() * rounded_rate + blurred() * limit;
        curve.raise_floor(doubt);
        const auto lets_go = [&](double x) {
            const MotionPoint at = point(x);
            const double M = field_.load(at);
            const double least = value(rate, x) + sign * rounded_rate;
            const double torque = pull_at(M, field_.push(at.t, at.side), least, value(belt, x));
            return standstill_.pulled(surely(torque, at.y.theta), at.y.theta) == side;
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

bool Engine::creep() {
    return !field_.has_belt() && standstill_.creep({now_.hi, theta(), pull(field_.load(here()))});
}

/// Without friction nothing happens at a turn, it is only told.
void Engine::record_turns(double until) {
    using namespace spectral::chebyshev;
    Series v = piece_.series[1];
    v[0] += y_[1];
    const double moving = greatest(piece_.y[1]);
    if (stays_above_zero(model::sign_of(standstill_.motion()), v, moving)) return;
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
