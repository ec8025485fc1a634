// The spectral engine's panels: how long, what M is on them, the motion they carry, and whether both are resolved.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/break_search.hpp"
#include "motion/spectral/spectral_engine.hpp"

namespace dinal::motion::spectral {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
// Lengths of time are in units of pace_.
/// A panel so short that what it does not resolve can not be seen in the motion.
constexpr double shortest = 1e-13;
/// So many of those one after the other, and there is nothing smooth about M.
constexpr int most_unresolved = 100;
/// So many panels that are not resolved, in steps below this length on average, or so many shorter ones in a row for no
/// break's sake, and there is no getting on.
constexpr double too_short = 1e-7;
constexpr int most_attempts = 100000;
/// With a feedback, whose panels are iterated, less; it passes each of its switches in some forty short ones.
constexpr int most_attempts_with_feedback = 10000;
constexpr int most_short_with_feedback = 2000;
/// Not resolved by more than this factor: it may be a break.
constexpr double gross = 1e3;
/// Found and still ahead: more would be the noise of M.
constexpr std::size_t most_found_breaks = 50;
/// Where M fails, the run comes this near to it.
constexpr double near_failure = 1e-9;

}  // namespace

double SpectralEngine::next_break() const {
    const double announced = excitation_.next_break(clock_.hi);
    return found_breaks_.empty() ? announced : std::min(announced, found_breaks_.front());
}

void SpectralEngine::choose_panel() {
    const double breaks = next_break();
    const double limit = std::min(window_.end, breaks);
    const double remaining = clock_.until(limit);
    if (bad_time_ < model::never) h_ = std::min(h_, clock_.until(bad_time_) / 4);
    to_limit_ = remaining <= 2 * h_ * (1 + 1e-9);
    panel_.start = clock_;
    panel_.begin = y_;
    panel_.motion = sliding();
    // Two panels of equal length rather than a long and a very short one.
    panel_.h = to_limit_ ? remaining / 2 : remaining < 4 * h_ ? remaining / 4 : h_;
    end_ = to_limit_ ? limit : clock_.after(2 * panel_.h);
    break_at_end_ = to_limit_ && limit == breaks;
    for (std::size_t j = 0; j + 1 < points; ++j) times_[j] = time_at(chebyshev::nodes[j]);
    times_[points - 1] = end_;
    standing_from_ = nowhere;
}

double SpectralEngine::sampled(std::size_t node, const model::State& state) const {
    return node + 1 == points && break_at_end_ ? excitation_.value_before(end_, state)
                                               : excitation_.value(times_[node], state);
}

/// M at all nodes for one state, of which only a feedback takes notice.
bool SpectralEngine::sample_all(const model::State& state) {
    const std::size_t first = M_sampled_ ? 1 : 0;
    if (M_sampled_) samples_[0] = M_;
    if (feedback_) {
        for (std::size_t j = first; j < points; ++j) {
            samples_[j] = sampled(j, state);
            if (!std::isfinite(samples_[j])) return bad_at(j);
        }
    } else {
        const std::size_t last = break_at_end_ ? points - 1 : points;
        const std::size_t count = last - first;
        const std::size_t good = excitation_.fill({&times_[first], count}, {&samples_[first], count});
        if (good < count) return bad_at(first + good);
        if (break_at_end_) samples_[points - 1] = excitation_.value_before(end_);
        if (!std::isfinite(samples_[points - 1])) return bad_at(points - 1);
    }
    panel_.M = chebyshev::fit(samples_);
    return true;
}

bool SpectralEngine::bad_at(std::size_t node) {
    bad_time_ = times_[node];
    return false;
}

/// M has failed ahead: the run goes on in ever shorter panels until it stands before that time, and ends there.
SpectralEngine::Attempt SpectralEngine::before_failure() {
    const bool there = clock_.until(bad_time_) <= std::max(near_failure * pace_, 64 * epsilon * std::fabs(clock_.hi));
    if (feedback_) bad_time_ = model::never;
    if (!there && excitation_.may_go_on()) return Attempt::shorten;
    fail(model::Outcome::excitation_not_finite);
    return Attempt::ended;
}

SpectralEngine::Attempt SpectralEngine::sample_standing() {
    if (!sample_all(y_)) return before_failure();
    return judge(unresolved_load());
}

/// The motion under this torque (M, or what is not linear in a feedback), from the state at the beginning.
void SpectralEngine::solve_for(const Series& torque) {
    const double h = panel_.h, inertia = system_.inertia();
    equation_.prepare(h * ((system_.damping() + chi_) / inertia), h * (h * ((system_.stiffness() + kappa_) / inertia)));
    const double scale = h * (h / inertia);
    Series r{};
    for (std::size_t k = 1; k < points; ++k) r[k] = scale * torque[k];
    const double friction = system_.braking(panel_.motion);
    const double k = system_.stiffness();
    r[0] = scale * ((std::fma(-k, y_.theta, torque[0]) - friction) - k * theta_rest_);
    panel_.w = equation_.solve(r, h * y_.velocity);
    v_ = chebyshev::integral(panel_.w, h * y_.velocity);
    p_ = chebyshev::integral(v_, 0.0);
}

SpectralEngine::Attempt SpectralEngine::solve() {
    if (feedback_) {
        switch (iterate()) {
            case Iteration::failed:
                // Perhaps for a state that only the iteration has been in: a shorter panel will tell.
                h_ = panel_.h / 2;
                bad_time_ = clock_.after(panel_.h);
                return before_failure();
            case Iteration::diverges:
                return judge(std::numeric_limits<double>::infinity());
            case Iteration::converged:
                break;
        }
    } else {
        if (!sample_all({})) return before_failure();
        solve_for(panel_.M);
    }
    if (!within_range()) {
        fail(model::Outcome::state_not_finite);
        return Attempt::ended;
    }
    return judge(feedback_ ? unresolved_motion() : std::max(unresolved_load(), unresolved_motion()));
}

/// Whether the motion on the panel, its torques, and the bounds that prove its events are numbers.
bool SpectralEngine::within_range() const {
    constexpr double largest = std::numeric_limits<double>::max() / 1e7;  // chebyshev::third_derivative_bound takes 2e6
    const double farthest = std::fabs(y_.theta) + chebyshev::size(p_), fastest = chebyshev::size(v_) / panel_.h;
    const auto fits = [](double x) { return x < largest; };
    return fits(farthest) && fits(system_.stiffness() * farthest) && fits(fastest) &&
           fits(system_.damping() * fastest) && fits(chebyshev::size(v_)) && fits(chebyshev::size(panel_.w));
}

// ---- resolved?

double SpectralEngine::lost_in_time() const {
    double slope = 0;
    for (std::size_t k = 1; k < points; ++k) slope += static_cast<double>(k * k) * std::fabs(panel_.M[k]);
    const double late = std::max(std::fabs(clock_.hi), std::fabs(end_));
    // A jump has a slope, too, on a panel short enough; it must not pass for this.
    constexpr double most = 1e-6;
    return std::min(4 * epsilon * late / panel_.h * slope, most * torques());
}

/// The last coefficients of M over what the tolerance allows, in units of the torques that are at play.
double SpectralEngine::unresolved_load() const {
    const Series& M = panel_.M;
    double allowed = (tolerance_ + 4 * epsilon) * torques();
    const double last = chebyshev::tail(M);
    if (last <= allowed) return allowed > 0 ? last / allowed : 0;
    allowed += lost_in_time();
    return last / allowed;
}

/// The same for the motion: the last coefficients of theta'' against velocity and acceleration.
double SpectralEngine::unresolved_motion() const {
    const auto& w = panel_.w;
    const double last = chebyshev::tail(w);
    const double v = chebyshev::size(v_), acceleration = chebyshev::size(w);
    double allowed = tolerance_ * std::max(v, acceleration);
    if (last <= allowed) return allowed > 0 ? last / allowed : 0;
    allowed += rounding_of_motion(lost_in_time());
    return last / allowed;
}

/// What theta'' on the panel may differ by because its torques are rounded, and M by `uncertain` more.
double SpectralEngine::rounding_of_motion(double uncertain) const {
    const double per_torque = panel_.h * (panel_.h / system_.inertia());
    const double a = panel_.h * ((system_.damping() + std::fabs(chi_)) / system_.inertia());
    const double b = per_torque * (system_.stiffness() + std::fabs(kappa_));
    const double terms = chebyshev::size(panel_.w) + a * chebyshev::size(v_) + b * chebyshev::size(p_);
    const double asked = torques() + std::fabs(kappa_ * y_.theta);  // a feedback is asked at a rounded theta
    const double rounding = 64 * epsilon * (terms + per_torque * asked) + per_torque * uncertain;
    if (!feedback_) return rounding;
    // The slopes of a feedback that switches are none; what it does must not pass for rounding.
    constexpr double most = 1e-6;
    return std::min(rounding, most * per_torque * torques());
}

/// Looks for a jump or kink of M in the panel, once in each order of magnitude of its length.
bool SpectralEngine::found_break() {
    const bool searched = searched_from_ == clock_.hi && panel_.h > 0.1 * searched_h_;
    if (searched || found_breaks_.size() >= most_found_breaks || !(unresolved_load() > gross)) return false;
    searched_from_ = clock_.hi, searched_h_ = panel_.h;
    const auto found = find_break(times_, samples_, [&](double t) { return excitation_.value(t, y_); });
    // One at the very beginning is not a break but a singular point, which ever shorter panels leave behind.
    if (!found || !(*found < end_)) return false;
    if (clock_.until(*found) < 1e-6 * panel_.h) {
        searched_h_ = 0;  // and need not be looked for again
        return false;
    }
    found_breaks_.insert(std::upper_bound(found_breaks_.begin(), found_breaks_.end(), *found), *found);
    return true;
}

/// A panel too short to matter, with M held at its first value: nothing happens in it, and M is asked at its end.
SpectralEngine::Attempt SpectralEngine::pass_over() {
    panel_.M = {};
    panel_.M[0] = samples_[0];
    kappa_ = chi_ = 0;
    if (panel_.motion != model::Motion::stuck) solve_for(panel_.M);
    return Attempt::resolved;
}

SpectralEngine::Attempt SpectralEngine::judge(double unresolved) {
    if (unresolved <= 1) {
        unresolved_in_a_row_ = 0;
        const bool needless = feedback_ || !to_limit_;
        short_in_a_row_ = needless && 2 * panel_.h < too_short * pace_ ? short_in_a_row_ + 1 : 0;
        if (short_in_a_row_ > (feedback_ ? most_short_with_feedback : most_attempts)) {
            fail(never_ending());
            return Attempt::ended;
        }
        lengthen(unresolved);
        return Attempt::resolved;
    }
    const double late = std::max(std::fabs(clock_.hi), std::fabs(end_));
    if (2 * panel_.h <= std::max(shortest * pace_, 16 * epsilon * late)) {
        // Whatever goes on here is over before it can move the mass. A feedback that switches may do so again at once.
        h_ = feedback_ ? 64 * panel_.h : h_max_;
        if (++unresolved_in_a_row_ <= most_unresolved) return pass_over();
        fail(never_ending());
        return Attempt::ended;
    }
    if (crawls()) {
        fail(never_ending());
        return Attempt::ended;
    }
    // While the mass is stuck its state is known, and a feedback is a function of time, too.
    const bool of_time = !feedback_ || (panel_.motion == model::Motion::stuck);
    if (script_ && of_time && unresolved > gross && found_break()) return Attempt::shorten;
    // The last coefficients fall with h^16.
    h_ = panel_.h * std::clamp(0.9 * std::pow(unresolved, -1.0 / chebyshev::degree), 0.5, 0.9);
    return Attempt::shorten;
}

/// Whether many attempts have led nowhere: M has more jumps than anyone could pass, or is rough at every scale.
bool SpectralEngine::crawls() {
    const int most = feedback_ ? most_attempts_with_feedback : most_attempts;
    if (++shortened_ < most) return false;
    const bool crawled = clock_.hi - shortened_since_ < too_short * most * pace_;
    shortened_ = 0, shortened_since_ = clock_.hi;
    return crawled;
}

void SpectralEngine::lengthen(double unresolved) {
    if (h_ >= h_max_) return;
    const double factor = 0.9 * std::pow(std::max(unresolved, 1e-16), -1.0 / chebyshev::degree);
    h_ = std::min(h_max_, std::max(h_, panel_.h * std::min(factor, 8.0)));
}

}  // namespace dinal::motion::spectral
