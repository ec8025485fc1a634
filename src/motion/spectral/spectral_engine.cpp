#include "motion/spectral/spectral_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/first_below.hpp"

namespace dinal::motion::spectral {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Within this time, in units of pace_, one standstill follows another at once, under a feedback. A function of time
/// moves the mass as often as it says.
constexpr double at_once = 1e-6;
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
      tolerance_(options.tolerance),
      w0_(problem.system.natural_frequency()),
      T0_(problem.system.natural_period()),
      pace_(std::min(T0_, problem.window.end - problem.window.start)),
      h_max_(std::min(options.max_panel, longest_panel * T0_) / 2),
      feedback_(problem.excitation.has_feedback() || system_.has_remainder()),
      script_(problem.excitation.has_script()),
      clock_{problem.window.start, 0},
      y_(problem.initial),
      standstill_(problem, &events, feedback_ ? at_once * pace_ : -model::never),
      h_(h_max_),
      shortened_since_(problem.window.start) {}

model::Outcome SpectralEngine::run() {
    begin();
    bool alive = std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
    while (alive && clock_.hi < window_.end) {
        if (pieces_++ % pieces_between_questions == 0 && monitor_ && !monitor_(clock_.hi)) {
            outcome_ = model::Outcome::interrupted;
            if (standstill_.phase() == Standstill::Phase::arrived) standstill_.ask(moment());
            break;
        }
        alive = advance();
    }
    if (outcome_ == model::Outcome::reached_end) finish();
    // The row of this very moment belongs to a piece that did not come about.
    if (outcome_ == model::Outcome::chattering && rows_.next_time() <= clock_.hi) put_row(M_);
    return outcome_;
}

void SpectralEngine::begin() {
    const double t = window_.start;
    const bool at_break = excitation_.next_break(std::nextafter(t, -model::never)) == t;
    M_ = at_break ? excitation_.value_after(t, y_) : excitation_.value(t, y_);
}

bool SpectralEngine::advance() {
    if (standstill_.phase() == Standstill::Phase::arrived && !go_on(standstill_.ask(moment()))) return false;
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
    panel_ = Panel{.start = clock_, .length = clock_.until(until), .begin = y_};
    if (panels_ != nullptr) panels_->add(panel_);
    clock_ = {until, 0};
    M_ = excitation_.value(until);
    return outcome_ == model::Outcome::reached_end;
}

void SpectralEngine::finish() {
    while (rows_.next_time() < model::never) put_row(M_);
    if (standstill_.phase() == Standstill::Phase::arrived) standstill_.ask(moment());
    if (standstill_.finish()) outcome_ = model::Outcome::at_rest;
}

// ---- moving

bool SpectralEngine::move() {
    choose_panel();
    if (const Attempt attempt = solve(); attempt != Attempt::resolved) return attempt != Attempt::ended;
    const bool stops = !standstill_.passes(), crept = stops && creeps();
    if (!stops) record_turns();
    const std::optional<double> zero = stops && !crept ? first_standstill() : std::nullopt;
    if (standstill_.phase() == Standstill::Phase::leaving && (crept || (zero && *zero <= -1))) {
        return go_on(standstill_.never_left(moment()));
    }
    double x = zero.value_or(1);
    if (x > -1 && time_at(x) >= end_) x = 1;
    const Clock theta = Clock{y_.theta, theta_rest_}.later(chebyshev::value(p_, x));  // a sum like that of time
    theta_rest_ = theta.lo;
    const model::State state{theta.hi, zero || crept ? 0 : chebyshev::value(v_, x) / panel_.h};
    const double M = x == 1 ? 0 : feedback_ ? excitation_.value(time_at(x), state) : chebyshev::value(panel_.M, x);
    end_piece(x, state, M);
    if (crept) settle();
    if (crept || zero) standstill_.arrive();
    standing_from_ = zero && x < 1 && !feedback_ ? x : nowhere;
    return std::isfinite(M_) || fail(model::Outcome::excitation_not_finite);
}

/// Whether all that goes on in the panel is slower than the rounding of its torques could make it.
bool SpectralEngine::creeps() const {
    const double fastest = chebyshev::size(v_) / panel_.h;
    return fastest * (system_.damping() + system_.inertia() / (2 * panel_.h)) <= 4 * epsilon * torques();
}

/// What has crept to rounding distance from its place is there: at the very limit of sticking, when Re = Rd.
void SpectralEngine::settle() {
    const double place = (M_ - system_.braking(standstill_.motion())) / system_.stiffness();
    const double near = 64 * epsilon * torques() / system_.stiffness();
    if (feedback_ || !(std::fabs(place - y_.theta) <= near)) return;
    y_.theta = place;
    theta_rest_ = 0;
}

/// Where the velocity is down to zero. At the end of the panel, zero within rounding is zero.
std::optional<double> SpectralEngine::first_standstill() const {
    using namespace chebyshev;
    const double sign = model::sign_of(standstill_.motion());
    const bool leaving = standstill_.phase() == Standstill::Phase::leaving;
    Bounded<points + 1> velocity(sign, v_, panel_.w);
    // The acceleration is what is left of torques that may balance each other.
    const double w0h = w0_ * panel_.h;
    velocity.raise_slope_floor(w0h * w0h * (64 * epsilon * torques() + lost_in_time()) / system_.stiffness());
    if (feedback_) velocity.raise_floor(rounding_of_motion(lost_in_time()));
    const auto always = [](double) { return true; };
    const auto zero = first_below(velocity, -1, leaving ? LeftEnd::leaving : LeftEnd::anywhere, always);
    if (!zero && velocity(1) <= velocity.floor()) return 1;
    return zero;
}

/// Without friction nothing happens at a turn, it is only told.
void SpectralEngine::record_turns() {
    using namespace chebyshev;
    constexpr double nothing = 1e-290;  // products of smaller numbers lose their digits to underflow
    const double moving = size(v_);
    // At its equilibrium a system changes the sign of its velocity by rounding alone.
    if (moving <= (feedback_ ? rounding_left_by_iteration : 1) * rounding_of_motion(lost_in_time()) || moving < nothing)
        return;
    if (standstill_.motion() == model::Motion::stuck) {
        // From a start at rest: the first velocity that is not rounding tells the direction.
        const auto v = at_nodes(v_);
        const auto* const first =
            std::find_if(v.begin(), v.end(), [&](double u) { return std::fabs(u) > 1e-14 * moving; });
        standstill_.head(model::motion_of(first == v.end() ? 0 : *first));
    }
    double from = -1;
    LeftEnd start = y_.velocity == 0 ? LeftEnd::leaving : LeftEnd::anywhere;
    const auto no = [](double) { return false; };
    while (standstill_.motion() != model::Motion::stuck) {
        const model::Motion motion = standstill_.motion();
        const Bounded<points + 1> velocity(model::sign_of(motion), v_, panel_.w);
        const auto x = first_below(velocity, from, start, no);
        if (!x) break;
        // A curve that leaves zero the other way was turned already, when that is told.
        const bool told =
            start == LeftEnd::leaving && *x <= from && (from > -1 || standstill_.last_told() == clock_.hi);
        if (told) {
            standstill_.head(motion == model::Motion::forward ? model::Motion::backward : model::Motion::forward);
        } else {
            standstill_.turned({time_at(*x), y_.theta + value(p_, *x), value(panel_.M, *x)});
        }
        if (told && from > -1) break;
        from = *x;
        start = LeftEnd::leaving;
    }
}

// ---- the present

void SpectralEngine::end_piece(double x, model::State state, double M) {
    const bool whole = x == 1;
    // A stuck piece may begin within the panel.
    Panel piece = panel_;
    piece.length = whole ? 2 * panel_.h : panel_.h * (1 + x);
    const bool told = rows_until(piece.length);
    if (panels_ != nullptr) {
        if (standstill_.stuck()) {
            const Clock from = clock_;
            piece.length -= from.hi == panel_.start.hi ? 0 : panel_.start.until(from.hi) + from.lo;
            piece.start = from;
            piece.begin = y_;
            piece.motion = model::Motion::stuck;
        }
        if (piece.length > 0) panels_->add(piece);
    }
    clock_ = whole && to_limit_ ? Clock{end_, 0} : panel_.start.later(whole ? 2 * panel_.h : panel_.h * (1 + x));
    y_ = state;
    if (whole) standing_from_ = nowhere;
    M_sampled_ = whole;
    M_ = !whole ? M : break_at_end_ ? excitation_.value_after(end_, y_) : samples_[points - 1];
    if (whole && feedback_ && !break_at_end_) M_ = excitation_.value(end_, y_);
    if (!told) M_ = std::numeric_limits<double>::quiet_NaN();
    if (whole) {
        std::erase_if(found_breaks_, [&](double b) { return b <= end_; });
        standstill_.go_on();
    }
}

/// The rows before the end of the piece; the one at its end belongs to the next. False when M fails at one of them.
bool SpectralEngine::rows_until(double length) {
    const bool standing = standstill_.stuck();
    while (rows_.next_time() < model::never) {
        const double t = rows_.next_time();
        const double since = panel_.start.until(t);
        if (!(since < length)) return true;
        const double x = std::clamp(since / panel_.h - 1, -1.0, 1.0);
        model::State state = y_;
        if (!standing && x > -1) {
            state = {y_.theta + chebyshev::value(p_, x), chebyshev::value(v_, x) / panel_.h};
        }
        double M = samples_[0];  // as it was given: M(0) = 0 is to be read as 0
        if (feedback_) {
            M = excitation_.value(t, state);
        } else if (x > -1) {
            M = chebyshev::value(panel_.M, x);
        }
        if (!std::isfinite(M)) return false;
        rows_.put(state, M, model::friction_torque(system_, standing ? model::Motion::stuck : panel_.motion, M, state));
    }
    return true;
}

}  // namespace dinal::motion::spectral
