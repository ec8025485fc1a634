// The exact engine's mass at rest, until breakaway.
#include <algorithm>
#include <cmath>

#include "motion/exact/exact_engine.hpp"

namespace dinal::motion::exact {

namespace {

/// The greatest cost of an arc at rest, in radians of its parts; it limits the accumulated rounding.
constexpr double greatest_cost_at_rest = 1e6;

}  // namespace

/// Makes a curve of M from the present on.
void ExactEngine::make_load() {
    load_.clear();
    for (const double c : formula_.powers()) load_.add_power(c);
    for (const auto& [omega, in_phase, quadrature] : formula_.sines()) load_.add_sine(omega, {in_phase, quadrature});
    for (const auto& [rate, amount] : formula_.exponentials()) load_.add_exponential(rate, amount);
    load_.begin();
}

/// Stays stuck up to the first time with |M - k theta| > Re or the end of the piece.
bool ExactEngine::stay() {
    const double cost = formula_.fastest() * static_cast<double>(1 + formula_.turning_parts());
    const double length =
        std::min({clock_.until(piece_end_), greatest_cost_at_rest / cost, formula_.grows_in() * growth_of_an_arc});
    cost_.spent += cost * length + Cost::of_a_line;
    const bool held = contact_.phase() == LoneContact::Phase::held;
    if (!held) {
        const model::Motion towards = contact_.pulled(M_, y_.theta);
        if (towards != model::Motion::stuck) return go_on(contact_.release(standstill(), towards));
    }
    make_load();
    const double bound = load_.fourth_bound(length);
    if (!within_range(bound)) return fail(model::Outcome::excitation_not_finite);
    if (held) return stay_held(length);
    const double k_theta = system_.stiffness() * y_.theta;
    const Band band{k_theta - contact_.limit(model::Motion::backward),
                    k_theta + contact_.limit(model::Motion::forward)};
    FirstExit exit(load_, band, 8 * epsilon * (system_.greatest_holding() + std::fabs(k_theta)));
    exit.bounded(bound);
    std::optional<Exit> found;
    if (const double guess = habits_.rest->length(); guess > 0) {
        found = exit.at_once(0, {M_, formula_.slope(), formula_.bend()}, guess, length);
        if (!found) habits_.rest->missed();
    }
    if (!found) found = exit.search(length);
    for (; found; found = exit.search(length)) {
        const model::Motion side = found->side > 0 ? model::Motion::forward : model::Motion::backward;
        if (clock_.after(found->tau) >= piece_end_) break;  // left to the next piece
        if (found->crosses) {
            habits_.rest->kept(found->tau);
            return release_at(found->tau, side, true);
        }
        // M touches the limit within rounding, so its exact value decides.
        if (contact_.pulled(excitation_.value(clock_.after(found->tau)), y_.theta) == side) {
            return release_at(found->tau, side, false);
        }
    }
    if (!end_arc(length, y_, 0)) return false;
    contact_.go_on();
    return std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
}

/// Stays after a release without motion until M is clearly beyond the limit, or clearly below it.
bool ExactEngine::stay_held(double length) {
    const double k_theta = system_.stiffness() * y_.theta, torque = std::fma(-system_.stiffness(), y_.theta, M_);
    const model::Motion side = torque > 0 ? model::Motion::forward : model::Motion::backward;
    const double Re = system_.holding(side), limit = k_theta + model::sign_of(side) * Re;
    const double torques = Re + std::fabs(k_theta) + std::fabs(M_);
    const double apart = 2 * std::max(contact_.excess(M_, y_.theta), 0.0) + 64 * epsilon * torques;
    FirstExit exit(load_, {limit - apart, limit + apart}, 8 * epsilon * torques);
    std::optional<Exit> found;
    do {
        found = exit.search(length);
    } while (found && !found->crosses);
    if (found && clock_.after(found->tau) < piece_end_) {
        const bool beyond = (found->side > 0) == (side == model::Motion::forward);
        if (beyond) return release_at(found->tau, side, false);
        if (!end_arc(found->tau, y_, 0)) return false;
    } else if (!end_arc(length, y_, 0)) {
        return false;
    }
    contact_.go_on();
    return std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
}

/// Breaks away. If M crosses the limit, its pull is set to the limit exactly, whatever the rounding of the time.
bool ExactEngine::release_at(double tau, model::Motion towards, bool crosses) {
    if (!end_arc(tau, y_, 0)) return false;
    if (!std::isfinite(M_)) return fail(model::Outcome::excitation_not_finite);
    if (crosses) {
        pull_at_release_ = model::sign_of(towards) * contact_.limit(towards) - system_.braking(towards);
    }
    const bool sane = contact_.release(standstill(), towards);
    if (contact_.stuck()) pull_at_release_.reset();  // the creep has ended in rest
    return go_on(sane);
}

}  // namespace dinal::motion::exact
