#include "motion/exact/exact_engine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dinal::motion::exact {

namespace {

/// The longest arc of a strongly decaying motion, as the exponent of its decay.
constexpr double decay_of_an_arc = 4;
/// The interval over which a creep is detected, in natural periods.
constexpr double creeps_over = 0.5 * (1 - 1e-9);
/// The greatest cost of an arc in radians of its parts, a fraction of a second of computation. The next two limit the
/// arcs and rows between calls of the monitor.
constexpr double greatest_cost = 1e7;
constexpr double arcs_between_questions = 16;
constexpr std::size_t rows_between_questions = 1U << 16U;

Band inside(model::Motion motion) {
    return motion == model::Motion::forward ? Band{.low = 0} : Band{.high = 0};
}

}  // namespace

ExactEngine::ExactEngine(const Problem& problem, RowWriter& rows, std::vector<model::Event>& events, Arcs* arcs)
    : system_(problem.system),
      excitation_(problem.drive.M()),
      monitor_(problem.monitor),
      window_(problem.window),
      rows_(rows),
      arcs_(arcs),
      clock_{problem.window.start, 0},
      y_(problem.drive.start()),
      piece_end_(problem.window.start),
      contact_(problem, &events, -model::never),
      arc_(system_),
      line_(system_, arc_.free()),
      load_(arc_.free()) {
    find_record();
    const double T0 = 2 * std::numbers::pi / arc_.free().w0();
    const double half = arc_.free().swings() ? std::numbers::pi / arc_.free().root().imag() : 0;
    habits_.moves = {Habit(half), Habit(half)}, habits_.swings = Habit(half);
    creep_ = {.damping = system_.damping(), .inertia = system_.inertia(), .shortest = creeps_over * T0};
}

model::Outcome ExactEngine::run() {
    update_M();
    bool alive = std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
    while (alive && clock_.hi < window_.end) {
        if (cost_.is_due() && asked_to_stop(clock_.hi)) {
            if (contact_.phase() == LoneContact::Phase::arrived) decide();
            break;
        }
        alive = advance();
    }
    if (outcome_ == model::Outcome::reached_end) finish();
    return outcome_;
}

bool ExactEngine::asked_to_stop(double t) {
    cost_.spent = 0;
    if (!monitor_ || monitor_(t)) return false;
    outcome_ = model::Outcome::interrupted;
    return true;
}

/// Updates the formula of M and its value.
void ExactEngine::update_M() {
    if (clock_.hi >= piece_end_) piece_end_ = std::min(excitation_.next_break(clock_.hi), window_.end);
    model::closed_form(excitation_, clock_.hi, clock_.lo, formula_);
    M_ = formula_.value();
}

bool ExactEngine::advance() {
    if (contact_.phase() == LoneContact::Phase::arrived && !continue_if(decide())) return false;
    if (along_lines()) return outcome_ == model::Outcome::reached_end;
    if (!contact_.stuck()) return move();
    return contact_.for_good(standstill()) ? rest_until_end() : stay();
}

/// Writes the remaining rows of a mass at rest, in portions if there are many.
bool ExactEngine::rest_until_end() {
    double until = window_.end;
    for (std::size_t count = 1; rows_.next_time() < window_.end; ++count) {
        const double t = rows_.next_time();
        M_ = excitation_.value(t);
        put_row();
        if (count % rows_between_questions == 0 && asked_to_stop(t)) {
            until = t;
            break;
        }
    }
    if (arcs_ != nullptr) arcs_->add({.start = clock_, .length = clock_.until(until), .begin = y_});
    clock_ = {until, 0};
    M_ = excitation_.value(until);
    return outcome_ == model::Outcome::reached_end;
}

void ExactEngine::finish() {
    while (rows_.next_time() < model::never) put_row();
    if (contact_.phase() == LoneContact::Phase::arrived) decide();
    if (contact_.finish()) outcome_ = model::Outcome::stuck_at_end;
}

// ---- moving

/// Returns whether the motion is far larger than the torques could cause. Its rounding would be too coarse once it has
/// decayed, so its arcs must be short.
bool ExactEngine::comes_from_afar() const {
    constexpr double far = 1024;
    const double k = system_.stiffness(), w0 = arc_.free().w0();
    return k * std::fabs(y_.theta) + system_.inertia() * w0 * std::fabs(y_.velocity) >
           far * (std::fabs(M_) + system_.greatest_holding());
}

bool ExactEngine::move() {
    const bool leaving = contact_.phase() == LoneContact::Phase::leaving;
    const double start_pull = pull_at_release_ ? *pull_at_release_ : pull();
    pull_at_release_.reset();
    const double cost = arc_.cost(formula_);
    requested_ = std::min({clock_.until(piece_end_), arc_.longest(formula_), formula_.grows_in() * growth_of_an_arc});
    if (cost * requested_ > greatest_cost) requested_ = greatest_cost / cost;
    if (comes_from_afar()) requested_ = std::min(requested_, decay_of_an_arc / arc_.free().decay());
    const double length = arc_.begin(formula_, {y_.velocity, start_pull}, requested_);
    cost_.spent += cost * length + Cost::between_calls / arcs_between_questions;
    bound_ = arc_.velocity().fourth_bound(length);
    if (!within_range(bound_)) {
        return fail(std::isfinite(formula_.value(length)) ? model::Outcome::state_not_finite
                                                          : model::Outcome::excitation_not_finite);
    }
    bool crept = false, left = true;
    std::optional<double> zero;
    if (!contact_.passes()) {
        zero = stop(start_pull, length, crept, left);
        if (leaving && !left)
            return contact_.creep(standstill()) || continue_if(contact_.failed_to_leave(standstill()));
    }
    double tau = zero.value_or(length);
    if (zero && clock_.after(tau) >= piece_end_) tau = clock_.until(piece_end_);
    if (crept) tau = *zero;
    // At a zero of the velocity, way() is the displacement at the last call of at(), which is near the zero.
    const Arc::Point y = zero ? Arc::Point{arc_.velocity().way(), 0} : arc_.at(tau);
    const Clock theta = Clock{y_.theta, theta_rest_}.later(y.way);
    if (!std::isfinite(theta.hi) || !std::isfinite(y.velocity)) return fail(model::Outcome::state_not_finite);
    const bool at_break = zero && clock_.after(tau) >= piece_end_;
    const double M_before = at_break ? formula_.value(tau) : 0;  // limit from the left
    if (!end_arc(tau, {theta.hi, y.velocity}, start_pull)) return false;
    theta_rest_ = theta.lo;
    if (crept) snap_to_equilibrium();
    if (zero && contact_.creep({clock_.hi, y_.theta, at_break ? M_before : M_})) return true;
    if (zero) {
        contact_.arrive();
    } else {
        contact_.note_time_passed();
    }
    return std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
}

/// The initial value and derivatives of the velocity at a standstill.
WalkedCurve::End ExactEngine::start_from_rest(double start_pull) const {
    const double first = start_pull / system_.inertia();
    return {0, first, (formula_.slope() - system_.damping() * first) / system_.inertia()};
}

bool ExactEngine::get_under_way(FirstExit& exit, double sign, double start_pull, double length) {
    const double I = system_.inertia(), C = system_.damping(), k = system_.stiffness();
    const auto [f, first, second] = start_from_rest(start_pull);
    const double third = (formula_.bend() - C * second - k * first) / I;
    return exit.leave(sign * first, sign * second, sign * third, length);
}

std::optional<double> ExactEngine::stop(double start_pull, double length, bool& crept, bool& left) {
    const model::Motion motion = contact_.motion();
    WalkedCurve& velocity = arc_.velocity();
    FirstExit exit(velocity, inside(motion), 0);
    exit.bounded(bound_);
    const double held = system_.stiffness() * std::fabs(y_.theta);
    creep_.least = 4 * epsilon * std::max(std::max(std::fabs(M_), held), system_.greatest_holding());
    creep_.fastest = creep_.least / creep_.resistance();
    exit.watch(creep_);
    double under_way = 0;
    const bool leaving = contact_.phase() == LoneContact::Phase::leaving;
    Habit& usual = habits_.moves[motion == model::Motion::forward ? 1 : 0];
    habits_.rest = &habits_.rests[motion == model::Motion::forward ? 1 : 0];
    if (const double guess = leaving ? usual.length() : 0; guess > 0) {
        if (const auto found = exit.at_once(0, start_from_rest(start_pull), guess, length)) {
            usual.kept(found->tau);
            return found->tau;
        }
        usual.missed();
    }
    if (leaving) {
        left = get_under_way(exit, model::sign_of(motion), start_pull, length);
        if (!left) return {};
        under_way = velocity.place();
    }
    const auto found = exit.search(length);
    crept = exit.crept();
    if (crept) {
        velocity.at(velocity.place());
        return velocity.place();
    }
    if (!found) return {};
    if (!found->crosses) velocity.at(found->tau);
    if (under_way > 0 && found->tau <= under_way) left = false;
    if (leaving) usual.walked(found->tau);
    return found->tau;
}

/// Sets a mass that has crept to within rounding of its equilibrium exactly there, which is the limit of sticking if Re
/// = Rd.
void ExactEngine::snap_to_equilibrium() {
    const double torques = std::fabs(M_) + system_.stiffness() * std::fabs(y_.theta) + system_.greatest_holding();
    const double place = (M_ - system_.braking(contact_.motion())) / system_.stiffness();
    if (!(std::fabs(place - y_.theta) <= 64 * epsilon * torques / system_.stiffness())) return;
    y_.theta = place;
    theta_rest_ = 0;
}

/// Records turns without friction, which do not change the motion.
void ExactEngine::record_turns(double start_pull, double length) {
    WalkedCurve& velocity = arc_.velocity();
    // At equilibrium the velocity changes sign by rounding alone.
    const double k = system_.stiffness();
    const double floor = 2 * epsilon * arc_.free().lasting() * (std::fabs(M_) / k + std::fabs(y_.theta));
    constexpr double nothing = 1e-290;
    if (velocity.size(length) <= std::max(floor, nothing)) return;
    FirstExit exit(velocity, {}, 0);
    exit.bounded(bound_);
    if (y_.velocity == 0) {
        const double I = system_.inertia(), first = start_pull / I;
        const double second = (formula_.slope() - system_.damping() * first) / I;
        const double third = (formula_.bend() - system_.damping() * second - k * first) / I;
        const model::Motion way = model::motion_of(first != 0 ? first : second != 0 ? second : third);
        if (way == model::Motion::stuck) return;
        const bool recorded = contact_.motion() == model::Motion::stuck || contact_.last_event_time() == clock_.hi;
        if (way != contact_.motion()) recorded ? contact_.set_direction(way) : contact_.turned(standstill());
        if (!get_under_way(exit, model::sign_of(way), start_pull, length)) return;
    } else if (contact_.motion() == model::Motion::stuck) {
        contact_.set_direction(model::motion_of(y_.velocity));
    }
    // Tries the previous interval between turns first, otherwise searches.
    bool behind = false;  // whether the walk has not passed the last turn
    double turn = 0;
    while (velocity.place() < length) {
        exit.set_band(inside(contact_.motion()));
        std::optional<Exit> found;
        if (exit.end().slope != 0) {
            const WalkedCurve::End start = exit.end();
            const double swing = habits_.swings.length();
            constexpr double near_by = 1e-4;
            if (swing > 0 && turn + swing < length) {
                const bool there = behind && std::fabs(turn - velocity.place()) <= near_by * swing;
                found = exit.at_once(turn, start, swing, length,
                                     there ? FirstExit::By::a_look : FirstExit::By::the_beginning);
                found ? habits_.swings.kept(found->tau - turn) : habits_.swings.missed();
            }
            if (!found && behind) exit.depart(turn, start, length);
            behind = found.has_value();
        }
        if (!found) {
            found = exit.search(length);
            if (!found) return;
            if (!found->crosses) continue;
        }
        turn = found->tau;
        // At a zero of the velocity, way() is the displacement near it.
        const double theta = Clock{y_.theta, theta_rest_}.later(velocity.way()).hi;
        contact_.turned({clock_.after(turn), theta, formula_.value(turn)});
        if (behind && !velocity.is_ahead()) velocity.look_at(turn);
        velocity.accept_look();
    }
}

// ---- the present

bool ExactEngine::end_arc(double tau, model::State state, double start_pull) {
    const bool standing = contact_.stuck();
    if (!rows_until(tau, state, standing)) return fail(model::Outcome::excitation_not_finite);
    if (contact_.passes()) record_turns(start_pull, tau);
    if (arcs_ != nullptr) keep(tau, start_pull, standing);
    const bool whole = clock_.after(tau) >= piece_end_;
    clock_ = whole ? Clock{piece_end_, 0} : clock_.later(tau);
    y_ = state;
    update_M();
    return outcome_ != model::Outcome::interrupted;
}

void ExactEngine::keep(double tau, double start_pull, bool standing) {
    if (!(tau > 0)) return;
    arcs_->add({.start = clock_,
                .length = tau,
                .requested = requested_,
                .begin = y_,
                .theta_rest = theta_rest_,
                .pull = start_pull,
                .motion = standing ? model::Motion::stuck : contact_.motion(),
                .rests = standing});
}

/// Writes the rows before the end of the arc; one at its end belongs to the next arc. Returns false if M is not finite
/// at one of them. If the monitor stops the run, the arc ends there.
bool ExactEngine::rows_until(double& tau, model::State& end, bool standing) {
    for (std::size_t count = 1; rows_.next_time() < model::never; ++count) {
        const double t = rows_.next_time(), since = clock_.until(t);
        if (!(since < tau)) return true;
        model::State state = y_;
        if (!standing && since > 0) {
            const Arc::Point y = arc_.at(since);
            state = {Clock{y_.theta, theta_rest_}.later(y.way).hi, y.velocity};
        }
        const double M = excitation_.value(t);
        if (!std::isfinite(M)) return false;
        const model::Motion motion = standing            ? model::Motion::stuck
                                     : contact_.passes() ? model::Motion::forward
                                                         : contact_.motion();
        rows_.put(state, M, model::friction_torque(system_, motion, M, state));
        if (count % rows_between_questions == 0 && asked_to_stop(t)) {
            tau = since;
            end = state;
            return true;
        }
    }
    return true;
}

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
        if (towards != model::Motion::stuck) return continue_if(contact_.release(standstill(), towards));
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
    contact_.note_time_passed();
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
    contact_.note_time_passed();
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
    return continue_if(sane);
}

}  // namespace dinal::motion::exact
