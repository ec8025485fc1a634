#include "motion/spectral/spectral_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/first_below.hpp"

namespace dinal::motion::spectral {

namespace {

/// What an iteration stops at, in roundings.
constexpr double rounding_left_by_iteration = 100;
/// Within this time one standstill follows another at once, under a feedback. A function of time moves the mass as
/// often as it says.
double at_once(const Problem& problem) {
    if (!problem.excitation.has_feedback()) return -model::never;
    return 1e-6 * std::min(problem.system.natural_period(), problem.window.end - problem.window.start);
}
/// Between two questions to the monitor: pieces, and rows at rest.
constexpr unsigned pieces_between_questions = 16;
constexpr std::size_t rows_between_questions = 1U << 16U;

}  // namespace

SpectralEngine::SpectralEngine(const Problem& problem, const Spectral& options, RowWriter& rows,
                               std::vector<model::Event>& events, Panels* panels)
    : system_(problem.system),
      excitation_(problem.excitation),
      monitor_(problem.monitor),
      window_(problem.window),
      rows_(rows),
      panels_(panels),
      T0_(std::min(problem.system.natural_period(), problem.window.end - problem.window.start)),
      now_{.clock = {problem.window.start, 0}, .y = problem.initial},
      standstill_(problem, &events, at_once(problem)),
      solver_(problem, options),
      corners_(solver_.slide()) {}

model::Outcome SpectralEngine::run() {
    begin();
    bool alive = std::isfinite(now_.M) || fail(model::Outcome::excitation_not_finite);
    while (alive && now_.clock.hi < window_.end) {
        if (pieces_++ % pieces_between_questions == 0 && monitor_ && !monitor_(now_.clock.hi)) {
            outcome_ = model::Outcome::interrupted;
            if (standstill_.phase() == Standstill::Phase::arrived) ask();
            break;
        }
        alive = advance();
    }
    if (outcome_ == model::Outcome::reached_end) finish();
    // The row of this very moment belongs to a piece that did not come about.
    if (outcome_ == model::Outcome::chattering) {
        standstill_.forget_chatter();
        if (rows_.next_time() <= now_.clock.hi) put_row(now_.M);
    }
    return outcome_;
}

void SpectralEngine::begin() {
    const double t = window_.start;
    const bool at_break = excitation_.next_break(std::nextafter(t, -model::never)) == t;
    now_.M = at_break ? excitation_.value_after(t, now_.y) : excitation_.value(t, now_.y);
}

bool SpectralEngine::advance() {
    if (standstill_.phase() == Standstill::Phase::arrived && !go_on(ask())) return false;
    if (!standstill_.stuck()) return move();
    return standstill_.for_good(moment()) ? rest_until_end() : stay();
}

/// At rest there is nothing to compute but M at the rows, of which there may be many.
bool SpectralEngine::rest_until_end() {
    double until = window_.end;
    for (std::size_t count = 1; rows_.next_time() < window_.end; ++count) {
        const double t = rows_.next_time();
        const double M = excitation_.value(t);
        put_row(M);
        if (count % rows_between_questions == 0 && monitor_ && !monitor_(t)) {
            outcome_ = model::Outcome::interrupted;
            until = t;
            break;
        }
    }
    if (panels_ != nullptr) {
        panels_->add(Panel{.start = now_.clock, .length = now_.clock.until(until), .begin = now_.y});
    }
    now_.clock = {until, 0};
    now_.M = excitation_.value(until);
    return outcome_ == model::Outcome::reached_end;
}

void SpectralEngine::finish() {
    while (rows_.next_time() < model::never) put_row(now_.M);
    if (standstill_.phase() == Standstill::Phase::arrived) ask();
    if (standstill_.finish()) outcome_ = model::Outcome::stuck_at_end;
}

// ---- moving

bool SpectralEngine::move() {
    standing_from_ = nowhere;
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    const model::State departing = leaving ? standstill_.on_its_way(now_.y) : now_.y;
    corners_.enter(model::sign_of(standstill_.motion()) * now_.y.velocity);
    const auto attempt = solver_.move(now_, sliding(), departing);
    if (attempt != PanelSolver::Attempt::resolved) return again(attempt);
    const bool stops = !standstill_.passes(), crept = stops && creeps();
    if (!stops) record_turns();
    const std::optional<double> zero = stops && !crept ? first_standstill() : std::nullopt;
    if (const auto corner = crept ? std::nullopt : first_corner(zero.value_or(1))) return cross(*corner);
    if (leaving && (crept || (zero && *zero <= -1))) {
        return standstill_.creep(moment()) || go_on(standstill_.never_left(moment()));
    }
    const SolvedPanel& panel = solver_.panel();
    double x = zero.value_or(1);
    if (x > -1 && panel.time(x) >= panel.end) x = 1;
    const Clock theta =
        Clock{now_.y.theta, now_.theta_rest}.later(chebyshev::value(panel.p, x));  // a sum like that of time
    now_.theta_rest = theta.lo;
    const model::State state{theta.hi, zero || crept ? 0 : chebyshev::value(panel.v, x) / panel.h};
    const double M = x == 1 ? 0 : M_at(x, state);
    const bool stands = crept || zero;
    const double M_before = stands && x == 1 ? chebyshev::value(panel.M, 1) : M;  // from the left
    end_piece(x, state, M);
    stands ? corners_.stop() : corners_.passed_on();
    if (crept) settle();
    const bool creeping = stands && !solver_.iterates() && standstill_.creep({now_.clock.hi, now_.y.theta, M_before});
    if (stands && !creeping) standstill_.arrive();
    standing_from_ = zero && x < 1 && solver_.M_of_time() ? x : nowhere;
    return std::isfinite(now_.M) || fail(model::Outcome::excitation_not_finite);
}

/// Whether all that goes on in the panel is slower than the rounding of its torques could make it.
bool SpectralEngine::creeps() const {
    const SolvedPanel& panel = solver_.panel();
    const double fastest = chebyshev::size(panel.v) / panel.h;
    return fastest * (system_.damping() + system_.inertia() / (2 * panel.h)) <= 4 * epsilon * solver_.torques();
}

/// What has crept to rounding distance from its place is there: at the very limit of sticking, when Re = Rd.
void SpectralEngine::settle() {
    if (system_.stiffness() == 0) return;
    const double place = (now_.M - system_.braking(standstill_.motion())) / system_.stiffness();
    const double near = 64 * epsilon * solver_.torques() / system_.stiffness();
    if (solver_.iterates() || !(std::fabs(place - now_.y.theta) <= near)) return;
    now_.y.theta = place;
    now_.theta_rest = 0;
}

/// Where the velocity is down to zero. At the end of the panel, zero within rounding is zero.
std::optional<double> SpectralEngine::first_standstill() const {
    using namespace chebyshev;
    const double sign = model::sign_of(standstill_.motion());
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    const SolvedPanel& panel = solver_.panel();
    if (const model::Slide& slide = solver_.slide(); slide.inside() && slide.range().from > 0) return {};
    Bounded<points + 1> velocity(sign, panel.v, panel.w);
    velocity.raise_slope_floor(solver_.least_rounding());
    if (solver_.iterates()) velocity.raise_floor(solver_.rounding());
    const auto always = [](double) { return true; };
    const auto zero = first_below(velocity, -1, leaving ? LeftEnd::leaving : LeftEnd::anywhere, always);
    if (!zero && velocity(1) <= velocity.floor()) return 1;
    return zero;
}

/// Without friction nothing happens at a turn, it is only told.
void SpectralEngine::record_turns() {
    using namespace chebyshev;
    constexpr double nothing = 1e-290;  // products of smaller numbers lose their digits to underflow
    const SolvedPanel& panel = solver_.panel();
    const double moving = size(panel.v);
    // At its equilibrium a system changes the sign of its velocity by rounding alone.
    const double least = (solver_.iterates() ? rounding_left_by_iteration : 1) * solver_.rounding();
    if (moving <= least || moving < nothing) return;
    if (standstill_.motion() == model::Motion::stuck) {
        // From a start at rest: the acceleration tells the direction, or the first velocity that is not rounding.
        const auto v = at_nodes(panel.v);
        const auto* const first =
            std::find_if(v.begin(), v.end(), [&](double u) { return std::fabs(u) > 1e-14 * moving; });
        const double pull = value(panel.w, -1);
        const bool pulled = std::fabs(pull) > 1e-12 * size(panel.w);
        standstill_.head(model::motion_of(pulled ? pull : first == v.end() ? 0 : *first));
    }
    double from = -1;
    LeftEnd start = now_.y.velocity == 0 ? LeftEnd::leaving : LeftEnd::anywhere;
    const auto no = [](double) { return false; };
    if (standstill_.motion() == model::Motion::stuck) return;
    Bounded<points + 1> velocity(model::sign_of(standstill_.motion()), panel.v, panel.w);
    for (;;) {
        const model::Motion motion = standstill_.motion();
        const auto x = first_below(velocity, from, start, no);
        if (!x) break;
        // A curve that leaves zero the other way was turned already, when that is told.
        const bool told =
            start == LeftEnd::leaving && *x <= from && (from > -1 || standstill_.last_told() == now_.clock.hi);
        if (told) {
            standstill_.head(motion == model::Motion::forward ? model::Motion::backward : model::Motion::forward);
        } else {
            standstill_.turned({panel.time(*x), now_.y.theta + value(panel.p, *x), value(panel.M, *x)});
        }
        if (told && from > -1) break;
        velocity.turn_over();
        from = *x;
        start = LeftEnd::leaving;
    }
}

// ---- the present

void SpectralEngine::end_piece(double x, model::State state, double M) {
    const bool whole = x == 1;
    const SolvedPanel& panel = solver_.panel();
    const double length = whole ? 2 * panel.h : panel.h * (1 + x);
    const bool told = rows_until(length);
    if (panels_ != nullptr) keep(length);
    gap_ = std::max(gap_, std::min(length, solver_.gap()));
    now_.clock = whole && panel.ends != SolvedPanel::End::inside ? Clock{panel.end, 0} : panel.start.later(length);
    now_.y = state;
    now_.M_sampled = whole;
    now_.M = whole ? M_at_end() : M;
    if (!told) now_.M = std::numeric_limits<double>::quiet_NaN();
    if (!whole) return;
    standing_from_ = nowhere;
    solver_.passed();
    standstill_.go_on();
}

/// Within the panel.
double SpectralEngine::M_at(double x, const model::State& state) const {
    const SolvedPanel& panel = solver_.panel();
    return solver_.M_of_time() ? chebyshev::value(panel.M, x) : excitation_.value(panel.time(x), state);
}

/// M from the right at the end of the panel, where the mass is now.
double SpectralEngine::M_at_end() const {
    const SolvedPanel& panel = solver_.panel();
    if (panel.ends == SolvedPanel::End::at_break) {
        // At a jump that was found M has jumped already; behind the end of the run it may fail.
        const bool found = excitation_.next_break(std::nextafter(panel.end, -model::never)) != panel.end;
        return found ? excitation_.value(panel.end, now_.y) : excitation_.value_after(panel.end, now_.y);
    }
    return solver_.M_of_time() ? panel.samples[points - 1] : excitation_.value(panel.end, now_.y);
}

/// A stuck piece may begin within the panel.
void SpectralEngine::keep(double length) {
    Panel piece = solver_.panel();
    piece.length = length;
    if (standstill_.stuck()) {
        const Clock from = now_.clock;
        piece.length -= from.hi == piece.start.hi ? 0 : piece.start.until(from.hi) + from.lo;
        piece.start = from;
        piece.begin = now_.y;
        piece.motion = model::Motion::stuck;
    }
    if (piece.length > 0) panels_->add(piece);
}

/// The rows before the end of the piece; the one at its end belongs to the next. False when M fails at one of them.
bool SpectralEngine::rows_until(double length) {
    const SolvedPanel& panel = solver_.panel();
    const bool standing = standstill_.stuck();
    while (rows_.next_time() < model::never) {
        const double t = rows_.next_time();
        const double since = panel.start.until(t);
        if (!(since < length)) return true;
        const double x = std::clamp(since / panel.h - 1, -1.0, 1.0);
        model::State state = now_.y;
        if (!standing && x > -1) {
            state = {now_.y.theta + chebyshev::value(panel.p, x), chebyshev::value(panel.v, x) / panel.h};
        }
        double M = panel.samples[0];  // as it was given: M(0) = 0 is to be read as 0
        if (!solver_.M_of_time()) {
            M = excitation_.value(t, state);
        } else if (x > -1) {
            M = chebyshev::value(panel.M, x);
        }
        const double friction =
            model::friction_torque(system_, standing ? model::Motion::stuck : panel.motion, M, state);
        if (!std::isfinite(M + friction)) return false;
        rows_.put(state, M, friction);
    }
    return true;
}

}  // namespace dinal::motion::spectral
