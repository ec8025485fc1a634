// The careful steps of the Runge-Kutta engine: pieces between events and breaks of M, and decisions at velocity 0.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/rk4/rk4_engine.hpp"

namespace dinal::motion::rk4 {

namespace {

/// The maximum of a unimodal f in [a, b] by golden sections, or the first positive value found.
template <class F>
std::pair<double, double> positive_peak(F&& f, double a, double b) {
    constexpr double golden = 0.6180339887498949;
    double x1 = b - golden * (b - a), x2 = a + golden * (b - a);
    double f1 = f(x1), f2 = f(x2);
    for (int i = 0; i < 60 && f1 <= 0 && f2 <= 0 && x1 < x2; ++i) {
        if (f1 < f2) {
            a = x1, x1 = x2, f1 = f2;
            x2 = a + golden * (b - a), f2 = f(x2);
        } else {
            b = x2, x2 = x1, f2 = f1;
            x1 = b - golden * (b - a), f1 = f(x1);
        }
    }
    return f1 > f2 ? std::pair{x1, f1} : std::pair{x2, f2};
}

}  // namespace

bool Rk4Engine::careful_step(double end, const Loads* known) {
    while (t_ < end) {
        const double next_break = excitation_.next_break(t_);
        const bool breaks = next_break <= end;
        if (!piece(breaks ? next_break : end, breaks, breaks ? nullptr : known)) return false;
        if (breaks) M_ = excitation_.value_after(t_, y_);
        if (!finite()) return false;
        // A step may contain a huge number of breaks.
        if (breaks && monitor_ && !monitor_(t_)) return fail(model::Outcome::interrupted);
        known = nullptr;
    }
    return true;
}

bool Rk4Engine::piece(double end, bool break_at_end, const Loads* known) {
    while (t_ < end) {
        if (contact_.phase() == LoneContact::Phase::arrived && !continue_if(decide())) return false;
        if (contact_.stuck()) {
            if (!stay(end, break_at_end, known)) return false;
            continue;
        }
        const double length = end - t_;
        const Stepped s = step(length, end, break_at_end, known);
        if (!std::isfinite(s.M)) return fail(model::Outcome::excitation_not_finite);
        if (!std::isfinite(s.y.theta) || !std::isfinite(s.y.velocity)) return fail(model::Outcome::state_not_finite);

        const double direction = model::sign_of(contact_.motion());
        const bool crosses = !(direction * s.y.velocity > 0) || (direction * s.a0 < 0 && direction * s.a1 > 0);
        if (contact_.passes()) {
            if (crosses) record_turns(t_, length, direction, y_, s.a0, s.y, s.a1);
        } else if (crosses) {
            const auto zero = first_velocity_zero(direction, length, y_.velocity, s.a0, s.y.velocity, s.a1);
            if (zero) {
                if (!reach_zero(s, *zero, end, break_at_end)) return false;
                continue;
            }
        }
        rows_until(end, StepInterpolant(length, y_, s.a0, s.y, s.a1));
        t_ = end, y_ = s.y, M_ = s.M;
        contact_.note_time_passed();
    }
    return finite();
}

Rk4Engine::Stepped Rk4Engine::step(double length, double end, bool break_at_end, const Loads* known) const {
    if (feedback_) return feedback_step(length, end, break_at_end, Evaluated::at_state);
    // Samples exist for whole steps only, but the one at the end serves every piece that ends there.
    const bool whole = known != nullptr && length > steps_.h * (1 - 1e-9);
    const double middle = whole ? known->middle : excitation_.value(t_ + length / 2);
    const double M1 = known != nullptr ? known->end : M_at(t_ + length, end, break_at_end, {});
    const double f0 = forcing(M_), f1 = forcing(M1);
    const model::State y =
        (whole ? block_.map : engine::AffineStep(block_.map.w, block_.map.c, length))(y_, f0, forcing(middle), f1);
    // A non-finite middle value must be detected even if the step is too short to change y.
    return {y, std::isfinite(middle) ? M1 : middle, acceleration(f0, y_), acceleration(f1, y)};
}

Rk4Engine::Stepped Rk4Engine::feedback_step(double length, double end, bool break_at_end, Evaluated evaluated) const {
    const double half = t_ + length / 2, t1 = t_ + length;
    const auto along = [&](double h, double v, double a) {
        return model::State{y_.theta + h * v, y_.velocity + h * a};
    };
    const auto M = [&](double t, const model::State& y) {
        return M_at(t, end, break_at_end,
                    evaluated == Evaluated::on_side_of_motion ? contact_.on_side_of_motion(y) : y);
    };
    const bool leaving = contact_.phase() == LoneContact::Phase::leaving;
    const double a0 = acceleration_at(y_, leaving ? excitation_.value(t_, contact_.on_side_of_motion(y_)) : M_);
    const model::State y2 = along(length / 2, y_.velocity, a0);
    const double a2 = acceleration_at(y2, M(half, y2));
    const model::State y3 = along(length / 2, y2.velocity, a2);
    const double a3 = acceleration_at(y3, M(half, y3));
    const model::State y4 = along(length, y3.velocity, a3);
    const double a4 = acceleration_at(y4, M(t1, y4));
    const model::State y1{y_.theta + length / 6 * (y_.velocity + 2 * y2.velocity + 2 * y3.velocity + y4.velocity),
                          y_.velocity + length / 6 * (a0 + 2 * a2 + 2 * a3 + a4)};
    const double way = model::sign_of(contact_.motion());
    const double least = std::min({way * y1.velocity, way * y2.velocity, way * y3.velocity, way * y4.velocity});
    if (evaluated == Evaluated::at_state && !(least > 0) && contact_.jumps(t1, y1.theta)) {
        return feedback_step(length, end, break_at_end, Evaluated::on_side_of_motion);
    }
    const double M1 = M(t1, y1);
    return {y1, std::isfinite(a2 + a3 + a4) ? M1 : a2 + a3 + a4, a0, acceleration_at(y1, M1)};
}

/// Advances to velocity zero at the time `zero` after the start of the piece; the friction law decides afterwards.
bool Rk4Engine::reach_zero(const Stepped& whole, double zero, double end, bool break_at_end) {
    if (zero <= 0 || t_ + zero <= t_) {
        if (y_.velocity != 0) {  // so close to zero that t + zero rounds to t
            y_.velocity = 0;
            M_ = contact_.M_at_rest(t_, y_.theta, M_);
            if (!contact_.creep(standstill())) contact_.arrive();
            return finite();
        }
        if (!contact_.creep(standstill()) && !continue_if(contact_.failed_to_leave(standstill()))) return false;
        rows_standing_until(end);
        t_ = end, M_ = feedback_ ? M_at(end, end, break_at_end, y_) : whole.M;
        contact_.note_time_passed();
        return finite();
    }
    const bool at_end = t_ + zero >= end;
    const double length = at_end ? end - t_ : zero;
    const Stepped s = at_end ? whole : step(length, end, break_at_end, nullptr);
    if (!std::isfinite(s.M)) return fail(model::Outcome::excitation_not_finite);
    const double t = at_end ? end : t_ + length;
    rows_until(t, StepInterpolant(length, y_, s.a0, s.y, s.a1));
    // The residual velocity of the cubic is of fourth order and is set to 0. An additional Newton step in time changed
    // no error by more than 5 %.
    y_ = {s.y.theta, 0};
    t_ = t, M_ = contact_.M_at_rest(t, y_.theta, s.M);
    if (!contact_.creep(standstill())) contact_.arrive();
    return finite();
}

/// Stays stuck up to the end of the piece or the first time with |M - k theta| > Re.
bool Rk4Engine::stay(double end, bool break_at_end, const Loads* known) {
    model::Motion next = contact_.pulled(M_, y_.theta);
    if (next == model::Motion::stuck) {
        double M_end = M_;
        const auto release = release_time(end, break_at_end, known, M_end);
        if (!std::isfinite(M_end)) return fail(model::Outcome::excitation_not_finite);
        rows_standing_until(release.value_or(end));
        t_ = release.value_or(end), M_ = M_end;
        if (!release) return finite();
        next = contact_.pulled(M_, y_.theta);
    }
    return continue_if(contact_.release(standstill(), next));
}

std::optional<double> Rk4Engine::release_time(double end, bool break_at_end, const Loads* known, double& M_end) const {
    const auto M = [&](double t) { return M_at(t, end, break_at_end, y_); };
    const auto excess_of = [&](double torque) { return contact_.excess(torque, y_.theta); };
    const auto excess = [&](double t) { return excess_of(M(t)); };
    const bool whole = known != nullptr && end - t_ > steps_.h * (1 - 1e-9);
    const double middle = t_ + (end - t_) / 2;
    const double M_middle = whole ? known->middle : M(middle);
    M_end = known != nullptr ? known->end : M(end);
    if (!std::isfinite(M_middle) || !std::isfinite(M_end)) {
        M_end = M_middle + M_end;
        return {};
    }
    const double e0 = std::min(excess_of(M_), 0.0), em = excess_of(M_middle), e1 = excess_of(M_end);
    double left = t_, e_left = e0, right = end, e_right = e1;
    if (!(em > 0)) {
        // If M peaks between the samples, the parabola through them shows whether it can reach the limit.
        const double a = (e0 - 2 * em + e1) / 2, b = (e1 - e0) / 2;
        const bool peak = a < 0 && std::fabs(b) < -2 * a;
        if (peak && em - b * b / (4 * a) - a / 4 > 0) {
            const auto [where, height] = positive_peak(excess, t_, end);
            if (height > 0) right = where, e_right = height;
        }
        if (!(e_right > 0)) return {};
        if (middle < right) left = middle, e_left = em;
    } else {
        right = middle, e_right = em;
    }
    const double release = first_positive(excess, left, e_left, right, e_right).second;
    M_end = M(release);
    return release;
}

/// Returns whether the mass is at its equilibrium, where the velocity changes sign by rounding alone.
bool Rk4Engine::lost_in_rounding(const model::State& y, double a) const {
    constexpr double few_ulps = 32 * std::numeric_limits<double>::epsilon();
    constexpr double nothing = 1e-290;  // products of smaller numbers underflow
    return std::fabs(a) <= few_ulps * block_.map.w * std::fabs(y.theta) ||
           (std::fabs(y.velocity) < nothing && std::fabs(y.theta) < nothing);
}

void Rk4Engine::record_turns(double t, double h, double direction, const model::State& y0, double a0,
                             const model::State& y1, double a1) {
    if (!std::isfinite(y1.theta) || !std::isfinite(y1.velocity)) return;  // no events once the state is not finite
    const StepInterpolant motion(h, y0, a0, y1, a1);
    if (direction == 0)
        direction = model::sign_of(model::motion_of(y0.velocity != 0 ? y0.velocity : a0 != 0 ? a0 : y1.velocity));
    if (lost_in_rounding(y0, a0) && lost_in_rounding(y1, a1)) direction = 0;
    double from = 0;
    model::State y = y0;
    double a = a0;
    while (direction != 0) {
        const auto zero = first_velocity_zero(direction, h - from, y.velocity, a, y1.velocity, a1);
        if (!zero || (*zero <= 0 && y.velocity == 0)) break;
        const TurnInStep turn(motion, h, from + *zero);
        const double x = turn.x > from ? turn.x : from + *zero;
        y = {motion(x).theta, 0};
        a = turn.slope;
        contact_.set_direction(model::motion_of(direction));
        contact_.turned({t + x, y.theta, excitation_.value(t + x, y)});
        direction = -direction;
        if (x >= h) break;
        from = x;
    }
    // The next step begins with the velocity at the end of this one, regardless of the zeros found.
    contact_.set_direction(model::motion_of(y1.velocity != 0 ? y1.velocity : direction));
}

}  // namespace dinal::motion::rk4
