// Whether a panel is resolved, how long the next one may be, and when there is no getting on.
#include <algorithm>
#include <cmath>
#include <limits>

#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

/// No torque, and no motion: what comes of numbers so small that they have lost their digits.
constexpr double underflow = std::numeric_limits<double>::min() / epsilon;
// Lengths of time are in units of pace_.
/// A panel so short that what it does not resolve cannot be seen in the motion.
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

}  // namespace

double PanelSolver::no_torque(const model::Excitation& excitation) {
    // So small a part of the greatest one, where that is known: then no unit makes a difference.
    constexpr double part = 1e-200;
    const double most = excitation.most();
    return most < model::never ? std::max(underflow, part * most) : underflow;
}

double PanelSolver::lost_in_time() const {
    if (tells_rests_) return 0;
    const double slope = chebyshev::derivative_bound<1>(panel_.M);
    const double late = std::max(std::fabs(panel_.start.hi), std::fabs(panel_.end));
    // A jump has a slope, too, on a panel short enough; it must not pass for this.
    constexpr double most = 1e-6;
    return std::min(4 * epsilon * late / panel_.h * slope, most * torques());
}

/// The last coefficients of M over what the tolerance allows, in units of the torques that are at play.
double PanelSolver::unresolved_load() const {
    const Series& M = panel_.M;
    double allowed = (tolerance_ + 4 * epsilon) * torques() + no_torque_ + noise_;
    const double last = chebyshev::tail(M);
    if (last <= allowed) return last / allowed;
    allowed += lost_in_time();
    return last / allowed;
}

/// The same for the motion: the last coefficients of theta'' against velocity and acceleration.
double PanelSolver::unresolved_motion() const {
    const auto& w = panel_.w;
    const double last = chebyshev::tail(w);
    const double v = chebyshev::size(panel_.v), acceleration = chebyshev::size(w);
    const double none = std::max(underflow, panel_.h * (panel_.h / system_.inertia()) * no_torque_);
    double allowed = tolerance_ * std::max(v, acceleration) + none;
    if (last <= allowed) return last / allowed;
    allowed += rounding_of_motion(lost_in_time() + no_torque_ + noise_);
    return last / allowed;
}

/// What theta'' on the panel may differ by because its torques are rounded, and M by `uncertain` more.
double PanelSolver::rounding_of_motion(double uncertain) const {
    const double per_torque = panel_.h * (panel_.h / system_.inertia());
    const double slope = std::fabs(falls_.velocity) + std::fabs(slope_of_line());
    const double a = panel_.h * ((system_.damping() + slope) / system_.inertia());
    const double b = per_torque * (system_.stiffness() + std::fabs(falls_.theta));
    const double terms = chebyshev::size(panel_.w) + a * chebyshev::size(panel_.v) + b * chebyshev::size(panel_.p);
    const double asked =
        torques() + std::fabs(falls_.theta * panel_.begin.theta);  // a feedback is asked at a rounded theta
    const double rounding = 64 * epsilon * (terms + per_torque * asked) + per_torque * uncertain;
    if (!iterates()) return rounding;
    // The slopes of a feedback that switches are none; what it does must not pass for rounding.
    constexpr double most = 1e-6;
    return std::min(rounding, most * per_torque * torques());
}

/// Looks for a jump or kink of M in the panel, once in each order of magnitude of its length.
bool PanelSolver::found_break() {
    const bool searched = searched_.from == panel_.start.hi && panel_.h > 0.1 * searched_.h;
    if (searched || found_breaks_.size() >= most_found_breaks || !(unresolved_load() > gross)) return false;
    searched_.from = panel_.start.hi, searched_.h = panel_.h;
    return find_break_among(panel_.times, panel_.samples);
}

bool PanelSolver::find_break_among(std::span<const double> times, std::span<const double> values) {
    const auto found = find_break(times, values, [&](double t) { return excitation_.value(t, panel_.begin); });
    // One at the very beginning is not a break but a singular point, which ever shorter panels leave behind.
    if (!found || !(*found <= panel_.end) || *found == break_after(panel_.start.hi)) return false;
    if (panel_.start.until(*found) < 1e-6 * panel_.h) {
        searched_.h = 0;  // and need not be looked for again
        return false;
    }
    found_breaks_.insert(std::upper_bound(found_breaks_.begin(), found_breaks_.end(), *found), *found);
    return true;
}

/// A panel too short to matter, with its torques held at their first values: nothing happens in it, and M is asked at
/// its end.
PanelSolver::Attempt PanelSolver::pass_over() {
    panel_.M = {};
    panel_.M[0] = panel_.samples[0];
    falls_.theta = falls_.velocity = 0;
    Series torque = panel_.M;
    if (system_.has_remainder()) torque[0] -= remainder(panel_.begin);
    if (panel_.motion != model::Motion::stuck) solve_for(torque);
    return Attempt::resolved;
}

/// Resolved; but so many short panels in a row lead nowhere.
PanelSolver::Attempt PanelSolver::accept() {
    patience_.unresolved = 0;
    const bool needless = feedback_ || panel_.ends == SolvedPanel::End::inside;
    patience_.too_short = needless && 2 * panel_.h < too_short * pace_ ? patience_.too_short + 1 : 0;
    const int most = feedback_ ? most_short_with_feedback : most_attempts;
    return patience_.too_short > most ? end_with(never_ending()) : Attempt::resolved;
}

PanelSolver::Attempt PanelSolver::judge(double unresolved) {
    if (unresolved <= 1) {
        Look look = script_ ? look_between() : Look::agrees;
        const bool known = slide_.inside() && !system_.has_spring();
        const bool corners = system_.has_remainder() && !known && panel_.motion != model::Motion::stuck;
        if (corners && look == Look::agrees) look = look_at_corners();
        if (look != Look::agrees) return looked(look);
        if (accept() == Attempt::ended) return Attempt::ended;
        lengthen(unresolved);
        return Attempt::resolved;
    }
    // On a short panel a jump of M is next to nothing in the motion.
    if (unresolved > gross || unresolved_load() > gross) missed_step();
    const double late = std::max(std::fabs(panel_.start.hi), std::fabs(panel_.end));
    if (!tells_rests_ && 2 * panel_.h <= std::max(shortest * pace_, 16 * epsilon * late)) {
        // Whatever goes on here is over before it can move the mass. A feedback that switches may do so again at once.
        h_ = feedback_ ? 64 * panel_.h : h_max_;
        if (++patience_.unresolved <= most_unresolved) return pass_over();
        return end_with(never_ending());
    }
    if (crawls()) return end_with(never_ending());
    if (script_ && found_noise()) return Attempt::shorten;
    // While the mass is stuck its state is known, and a feedback is a function of time, too.
    const bool of_time = !feedback_ || (panel_.motion == model::Motion::stuck);
    if (script_ && of_time && unresolved > gross && found_break()) return Attempt::shorten;
    // The last coefficients fall with h^16.
    h_ = panel_.h * std::clamp(0.9 * std::pow(unresolved, -1.0 / chebyshev::degree), 0.5, 0.9);
    return Attempt::shorten;
}

/// Whether many attempts have led nowhere: M has more jumps than anyone could pass, or is rough at every scale.
bool PanelSolver::crawls() {
    const int most = feedback_ ? most_attempts_with_feedback : most_attempts;
    if (++patience_.shortened < most) return false;
    const bool crawled = panel_.start.hi - patience_.since < too_short * most * pace_;
    patience_.shortened = 0, patience_.since = panel_.start.hi;
    return crawled;
}

void PanelSolver::lengthen(double unresolved) {
    if (h_ >= h_max_) return;
    const double factor = 0.9 * std::pow(std::max(unresolved, 1e-16), -1.0 / chebyshev::degree);
    h_ = std::min(h_max_, std::max(h_, panel_.h * std::min(factor, 8.0)));
}

/// Where M has jumped evenly, its next jump is known before it is met.
void PanelSolver::foresee_break() {
    const auto next = passed_breaks_.next(end_of_run_, [&](double t) { return excitation_.value(t); });
    if (next) found_breaks_.push_back(*next);
}

void PanelSolver::passed() {
    bool at_found = false;
    std::erase_if(found_breaks_, [&](double b) {
        if (!(b <= panel_.end)) return false;
        passed_breaks_.pass(b);
        return at_found = true;
    });
    if (at_found && !feedback_ && found_breaks_.empty()) foresee_break();
    if (seen_ <= panel_.end) seen_ = model::never;
}

}  // namespace dinal::motion::spectral
