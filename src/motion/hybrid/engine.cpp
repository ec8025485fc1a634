#include "motion/hybrid/engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::motion::hybrid {

namespace {

/// In units of the pace: what cannot be seen in the motion, and how near a run comes to where a function fails.
constexpr double shortest = 1e-13, near_failure = 1e-9;
/// Shorter than this part of the longest piece is short.
constexpr double short_part = 1e-3;
/// So many pieces that are not resolved one after the other, or so many in next to no time, lead nowhere.
constexpr int most_short = 2000, most_attempts = 20000;

/// As the Standstill sees the problem: velocities against the belt.
Problem on_belt(const Problem& problem, double belt) {
    return {problem.system, problem.excitation, {problem.initial.theta, problem.initial.velocity - belt},
            problem.window, problem.rows,       problem.monitor,
            problem.limits, problem.before,     problem.course_bytes};
}

bool breaks_at(const Field& field, double t) {
    return field.next_break(std::nextafter(t, -model::never)) == t;
}

}  // namespace

Engine::Engine(const Problem& problem, const Cut& cut, Trajectory& trajectory, std::vector<model::Event>& events,
               const std::shared_ptr<Pieces>& pieces)
    : problem_(problem),
      extras_(*problem.extras),
      system_(problem.system),
      events_(events),
      pieces_(pieces),
      field_(problem, *pieces),
      cut_(cut),
      solver_(problem, field_, cut),
      corners_(solver_.slide()),
      standstill_(on_belt(problem, field_.belt(problem.window.start, Side::after)), &events, 1e-6 * pace_of(problem)),
      now_{problem.window.start, 0},
      h_(cut.longest / 2),
      pace_(pace_of(problem)),
      born_(problem.window.start),
      attempts_since_(problem.window.start) {
    if (!extras_.states.empty()) trajectory.own_names = column_names();
    for (const model::OwnState& state : extras_.states) trajectory.own_names.push_back(state.name);
    Growing<double> table(problem.rows.count(), trajectory.names().size());
    column_ = table.writable();
    trajectory.rows = Rows(std::move(table));
}

bool Engine::begin() {
    y_ = {problem_.initial.theta, problem_.initial.velocity};
    reach_ = std::fabs(y_[0]);
    const auto* left = dynamic_cast<const Left*>(problem_.carried);
    for (std::size_t i = 0; i < extras_.states.size(); ++i) {
        y_.push_back(left != nullptr ? left->states[i] : extras_.states[i].start);
    }
    after_break_ = breaks_at(field_, now_.hi);
    watches_.resize(extras_.events.size());
    if (left != nullptr) {
        field_.remember(left->controllers);
        watches_ = left->watches;
        echoes_ = left->echoes;
        born_ = left->born;
    } else {
        field_.begin(here());
        echo(now_.hi, 1);
    }
    touch_wall(problem_.before.has_value());
    return field_.arrive(here()) || fail(model::Outcome::excitation_not_finite);
}

model::Outcome Engine::run() {
    bool alive = begin();
    unsigned pieces = 0;
    constexpr unsigned between_questions = 16;
    while (alive && now_.hi < problem_.window.end) {
        if (pieces++ % between_questions == 0 && problem_.monitor && !problem_.monitor(now_.hi)) {
            outcome_ = model::Outcome::interrupted;
            break;
        }
        alive = advance();
    }
    if (outcome_ == model::Outcome::reached_end || outcome_ == model::Outcome::stopped) {
        if (standstill_.phase() == Standstill::Phase::arrived && outcome_ == model::Outcome::reached_end) ask();
        const Grid& rows = problem_.rows;
        while (next_row_ < rows.count() && rows.time(next_row_) <= now_.hi && put_row(now_.hi, -2)) {
        }
    }
    if (outcome_ == model::Outcome::reached_end && standstill_.finish()) outcome_ = model::Outcome::stuck_at_end;
    return outcome_;
}

/// Where the next piece ends.
bool Engine::choose() {
    const double breaks = std::min(field_.next_break(now_.hi), echoes_.empty() ? model::never : echoes_.front().first);
    double limit = std::min({problem_.window.end, breaks, belt_turns_});
    // Up to a jump of the belt, and from there over it.
    const double at_jump = before_jump() ? belt_jump_ : std::nextafter(belt_jump_, -model::never);
    limit = std::min(limit, at_jump);
    if (cut_.h > 0) {
        // A break that rounding puts beside a step's end is that end.
        const double beside = std::max(1e-9 * cut_.h, 4 * rounding * std::fabs(now_.hi));
        const double steps = std::floor((now_.hi - problem_.window.start + beside) / cut_.h) + 1;
        const double step_end = problem_.window.start + steps * cut_.h;
        if (step_end < limit - beside) limit = step_end;
    }
    double h = std::min({rung(h_, cut_.longest / 2), field_.view(now_.hi, spectral::chebyshev::widest_gap) / 2,
                         field_.shortest_delay() / 2 * (1 - 1e-12)});
    if (bad_time_ < model::never) h = std::min(h, now_.until(bad_time_) / 4);
    // As long as it takes to a wall, or back to it, and a little more: a small bounce is to be seen.
    if (problem_.system.walls() && !standstill_.stuck()) h = std::min(h, std::max(0.6 * until_wall(), 1e-9 * pace_));
    if (watches_corners()) h = std::min(h, longest_under_friction() / 2);
    if (flight_.side != 0 && flight_.side * (flight_.from - theta()) < 0) flight_.side = 0;
    if (flight_.side != 0 && !standstill_.stuck()) {
        h = std::min(h, std::max(0.6 * until(flight_.side, flight_.from, acceleration()), 1e-9 * pace_));
    }
    const double remaining = now_.until(limit);
    const bool to_limit = remaining <= 2 * h * (1 + 1e-9);
    piece_.start = now_;
    piece_.way = way();
    piece_.leans = leans();
    const model::SpeedRange* line = piece_.way == model::Motion::stuck ? nullptr : solver_.slide().line();
    piece_.friction = line != nullptr ? *line : model::SpeedRange{};
    piece_.origin = origin_;
    piece_.h = to_limit ? remaining / 2 : remaining < 4 * h ? remaining / 4 : h;
    piece_.end = to_limit ? limit : now_.after(2 * piece_.h);
    piece_.from_break = after_break_;
    piece_.to_break = to_limit && limit == breaks;
    piece_.to_the_end = piece_.to_break || (to_limit && (limit == problem_.window.end || limit == at_jump));
    return piece_.h > 0 || fail(model::Outcome::chattering);
}

void Engine::again(Solver::Attempt attempt) {
    if (++attempts_ >= most_attempts) {
        if (now_.hi - attempts_since_ < 1e-7 * most_attempts * pace_) {
            get_nowhere(model::Outcome::unresolved);
            return;
        }
        attempts_ = 0, attempts_since_ = now_.hi;
    }
    if (attempt == Solver::Attempt::failed) {
        bad_time_ = solver_.bad_time();
        const double near = std::max(near_failure * pace_, 64 * rounding * std::fabs(now_.hi));
        if (cut_.h > 0 || now_.until(bad_time_) <= near || !field_.may_go_on() || !problem_.system.may_go_on()) {
            fail(model::Outcome::excitation_not_finite);
        }
        h_ = piece_.h / 2;
        return;
    }
    const double unresolved = solver_.unresolved();
    const double factor = unresolved < model::never ? 0.9 * std::pow(unresolved, -1.0 / 16) : 0;
    h_ = piece_.h * std::clamp(factor, 0.5, 0.9);
}

bool Engine::advance() {
    if (standstill_.phase() == Standstill::Phase::arrived && !ask()) return false;
    if (standstill_.stuck() && standstill_.phase() != Standstill::Phase::held) {
        const double M = field_.load(here());
        if (!std::isfinite(pull(M))) return fail(model::Outcome::excitation_not_finite);
        const model::Motion towards = standstill_.pulled(surely(pull(M), theta()), theta());
        if (towards != model::Motion::stuck && !find_jump_here() && !release(towards)) return false;
    }
    if (watches_corners()) corners_.enter(model::sign_of(standstill_.motion()) * (y_[1] - belt()));
    if (!choose()) return false;
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving && !standstill_.passes();
    model::State departing{y_[0], y_[1]};
    if (leaving) {
        const double slip = standstill_.on_its_way({theta(), y_[1] - belt()}).velocity;
        departing.velocity = belt() + slip;
    }
    const auto attempt = solver_.solve(piece_, y_, departing);
    const double late = std::max(std::fabs(now_.hi), std::fabs(piece_.end));
    const bool over_jump = piece_.end == belt_jump_;
    const bool may_jump = attempt == (cut_.h > 0 ? Solver::Attempt::resolved : Solver::Attempt::shorten);
    if (may_jump && field_.has_belt() && !over_jump) {
        belt_jump_ = std::min(belt_jump_, solver_.jump_of_belt(piece_));
        if (belt_jump_ <= piece_.end) return true;
    }
    if (over_jump && attempt != Solver::Attempt::failed) {
        solver_.pass_over(piece_);
    } else if (attempt == Solver::Attempt::shorten &&
               2 * piece_.h <= std::max(shortest * pace_, 16 * rounding * late)) {
        if (++too_short_ > most_short) return get_nowhere(model::Outcome::chattering);
        solver_.pass_over(piece_);
        h_ = 64 * piece_.h;
    } else if (attempt != Solver::Attempt::resolved) {
        again(attempt);
        return outcome_ == model::Outcome::reached_end;
    } else {
        if (2 * piece_.h > 1e-7 * pace_) too_short_ = 0;
        const double factor = 0.9 * std::pow(std::max(solver_.unresolved(), 1e-16), -1.0 / 16);
        // Where a short piece is resolved but for noise, longer ones are no rougher.
        const double least = piece_.h < short_part * cut_.longest ? 2 : 0;
        if (cut_.h == 0) h_ = std::min(cut_.longest / 2, std::max(h_, piece_.h * std::clamp(factor, least, 8.0)));
    }

    if (belt_turns_at_wall()) return true;

    Ending ending;
    if (standstill_.stuck()) {
        // A pull that stays has been asked already.
        const bool asked = piece_.held && standstill_.phase() != Standstill::Phase::held;
        const auto [x, towards] = asked ? std::pair(2.0, model::Motion::stuck) : first_release();
        if (x < 1) ending = {x, By::surface, 0, towards};
    } else if (!standstill_.passes()) {
        const bool crept = creeps();
        const auto zero = crept ? std::optional(leaving ? -1.0 : 1.0) : first_standstill();
        if (leaving && zero && *zero <= -1) {
            return creep() || standstill_.never_left({now_.hi, theta(), pull(field_.load(here()))}) ||
                   fail(model::Outcome::chattering);
        }
        if (zero) ending = {*zero, By::surface};
    }
    const auto corner = watches_corners() ? first_corner(ending.x) : std::nullopt;
    if (corner) ending = {corner->x, By::corner};
    if (ending.x > -1 && ending.x < 1 && piece_.time(ending.x) >= piece_.end) ending.x = 1;
    if (problem_.system.walls() && !leans()) watch_walls(ending);
    watch(ending);
    if (outcome_ != model::Outcome::reached_end) return false;
    if (standstill_.passes()) record_turns(ending.x);
    if (ending.by == By::corner && !corners_.cross(*corner)) return true;
    if (!end_piece(ending.x)) return false;
    if (ending.by == By::corner) {
        go_over(*corner);
    } else {
        ending.by == By::nobody ? corners_.passed_on() : corners_.stop();
    }
    return handle(ending);
}

/// The piece has come to an end at x: its rows, and the present.
bool Engine::end_piece(double x) {
    const bool whole = x >= 1;
    const double length = whole ? 2 * piece_.h : piece_.h * (1 + x);
    if (!rows_until(whole ? piece_.end : piece_.start.later(length).hi, whole)) {
        return fail(model::Outcome::excitation_not_finite);
    }
    keep(length);
    gap_ = std::max(gap_, std::min(length, cut_.h > 0 ? piece_.h : 2 * cheb::widest_gap * piece_.h));
    if (x > -1) {
        for (std::size_t k = 0; k < y_.size(); ++k) y_[k] = piece_.at(k, x);
    }
    reach_ = std::max(reach_, std::fabs(y_[0]));
    now_ = whole && piece_.to_the_end ? Clock{piece_.end, 0} : piece_.start.later(length);
    after_break_ = whole && piece_.to_break;
    if (bad_time_ <= now_.hi) bad_time_ = model::never;
    if (belt_turns_ <= now_.hi) belt_turns_ = model::never;
    if (belt_jump_ <= now_.hi) belt_jump_ = model::never;
    const double belt_here = whole ? piece_.belt[node_count - 1] : belt();
    if (standstill_.stuck()) y_[1] = leans() ? 0 : belt_here;
    if (whole && length > 0) standstill_.go_on();
    int generation = 0;
    while (!echoes_.empty() && echoes_.front().first <= now_.hi) {
        generation = std::max(generation, echoes_.front().second);
        echoes_.erase(echoes_.begin());
    }
    if (generation > 0) echo(now_.hi, generation + 1);
    if (!whole || ((after_break_ || piece_.passed) && generation == 0)) echo(now_.hi, 1);
    if (!field_.arrive(here())) return fail(model::Outcome::excitation_not_finite);
    const bool may_jump = (whole && piece_.passed) || (after_break_ && field_.belt_breaks(now_.hi));
    return !may_jump || !field_.has_belt() || belt_jumps(belt_here);
}

void Engine::keep(double length) {
    if (!(length > 0) || (!problem_.limits.dense && field_.delays().empty())) return;
    Piece piece{.start = piece_.start,
                .h = piece_.h,
                .length = length,
                .way = piece_.way,
                .leans = piece_.leans,
                .begin = y_,
                .series = piece_.series,
                .M = cheb::fit(piece_.M),
                .friction = piece_.friction};
    if (field_.has_surroundings()) {
        piece.around = std::make_shared<const Piece::Surroundings>(
            Piece::Surroundings{cheb::fit(piece_.push), cheb::fit(piece_.belt), cheb::fit(piece_.belt_rate)});
    }
    piece.begin[0] += piece_.origin;
    pieces_->add(std::move(piece));
    if (problem_.limits.dense) return;
    const auto delays = field_.delays();
    pieces_->forget(now_.hi - 2 * *std::max_element(delays.begin(), delays.end()));
}

void Engine::leave(Trajectory& trajectory) const {
    trajectory.t_start = problem_.window.start;
    trajectory.t_stop = now_.hi;
    const auto& walls = problem_.system.walls();
    // Beside a wall its distance has digits that theta has not.
    const double place = walls ? std::clamp(theta(), walls->lower, walls->upper) : theta();
    trajectory.state_at_stop = {place, y_[1]};
    trajectory.motion_at_stop = standstill_.motion();
    trajectory.began_stuck = standstill_.began_stuck();
    trajectory.rough = rough_;
    if (field_.asks_functions()) trajectory.gap = gap_;
    if (next_row_ < problem_.rows.count()) trajectory.rows = Rows(trajectory.rows.table().first(next_row_));
    auto left = std::make_shared<Left>();
    left->states.assign(y_.begin() + 2, y_.end());
    left->controllers = field_.memory();
    left->watches = watches_;
    left->echoes = echoes_;
    left->born = born_;
    if (!field_.delays().empty()) left->past = pieces_;
    Values end = y_;
    end[0] = place;
    pieces_->close(now_, std::move(end));
    trajectory.carried = std::move(left);
}

Trajectory run(const Problem& problem, const Cut& cut) {
    Trajectory trajectory;
    std::vector<model::Event> events;
    const auto* left = dynamic_cast<const Left*>(problem.carried);
    const auto pieces =
        std::make_shared<Pieces>(problem.system, problem.initial, problem.window.start,
                                 left != nullptr ? left->past : nullptr, problem.course_bytes, cut.h == 0);
    Engine engine(problem, cut, trajectory, events, pieces);
    trajectory.outcome = engine.run();
    engine.leave(trajectory);
    for (const model::WantedEvent& wanted : problem.extras->events) trajectory.event_names.push_back(wanted.name);
    trajectory.events = Growing<model::Event>(std::move(events));
    if (problem.limits.dense) trajectory.course = pieces;
    return trajectory;
}

}  // namespace dinal::motion::hybrid
