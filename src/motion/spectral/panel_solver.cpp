#include "motion/spectral/panel_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dinal::motion::spectral {

namespace {

/// Where M fails, the run comes this near to it, in units of pace_.
constexpr double near_failure = 1e-9;

}  // namespace

PanelSolver::PanelSolver(const Problem& problem, const Spectral& options)
    : system_(problem.system),
      slide_(system_),
      excitation_(problem.excitation),
      end_of_run_(problem.window.end),
      tolerance_(options.tolerance),
      pace_(std::min(problem.system.natural_period(), problem.window.end - problem.window.start)),
      no_torque_(no_torque(excitation_)),
      h_max_(options.longest(problem) / 2),
      feedback_(problem.excitation.has_feedback() || system_.has_spring() ||
                (system_.has_friction_remainder() && !slide_.has_corners())),
      script_(problem.excitation.has_script()),
      tells_rests_(problem.excitation.tells_rests()),
      oscillator_(problem.system),
      h_(h_max_),
      patience_{.since = problem.window.start} {}

double PanelSolver::break_after(double t) const {
    const double announced = excitation_.next_break(t);
    return found_breaks_.empty() ? announced : std::min(announced, found_breaks_.front());
}

void PanelSolver::choose(const Present& now, model::Motion way) {
    const double breaks = break_after(now.clock.hi), limit = std::min({end_of_run_, breaks, steps_.stop});
    const double remaining = now.clock.until(limit);
    h_ = std::min(h_, excitation_.view(now.clock.hi, chebyshev::widest_gap) / 2);
    if (bad_time_ < model::never) h_ = std::min(h_, now.clock.until(bad_time_) / 4);
    const bool to_limit = remaining <= 2 * h_ * (1 + 1e-9);
    // Two panels of equal length rather than a long and a very short one.
    const double h = to_limit ? remaining / 2 : remaining < 4 * h_ ? remaining / 4 : h_;
    lay(now, way, h, to_limit ? limit : now.clock.after(2 * h));
    if (!to_limit) return;
    if (limit == end_of_run_) panel_.ends = SolvedPanel::End::window;
    if (limit == breaks) panel_.ends = SolvedPanel::End::at_break;
}

/// The place of the panel in time.
void PanelSolver::lay(const Present& now, model::Motion way, double h, double end) {
    panel_.ends = SolvedPanel::End::inside;
    panel_.start = now.clock;
    panel_.begin = now.y;
    panel_.motion = way;
    panel_.h = h;
    panel_.length = 2 * h;
    panel_.friction = {};
    panel_.line = -1;
    if (const model::SpeedRange* line = slide_.line(); way != model::Motion::stuck && line != nullptr) {
        panel_.friction = *line;
        panel_.line = static_cast<std::int32_t>(slide_.index());
    }
    panel_.end = end;
    if (system_.has_remainder()) own_spring_ = std::fabs(system_.spring(now.y.theta));
    const double before_end = std::max(std::nextafter(end, -model::never), now.clock.hi);  // where M may jump
    for (std::size_t j = 0; j + 1 < points; ++j) {
        panel_.times[j] = std::min(panel_.time(chebyshev::nodes[j]), before_end);
        panel_.rests[j] = h * (1 + chebyshev::nodes[j]) - now.clock.until(panel_.times[j]);
    }
    spread_.middle = panel_.times[chebyshev::degree / 2], spread_.rest = panel_.rests[chebyshev::degree / 2],
    spread_.half = h;
    panel_.times[points - 1] = panel_.end;
    panel_.rests[points - 1] = 2 * h - now.clock.until(panel_.end);
}

double PanelSolver::sampled(std::size_t node, const model::State& state) const {
    return node + 1 == points && panel_.ends == SolvedPanel::End::at_break
               ? excitation_.value_before(panel_.end, state)
               : excitation_.value(panel_.times[node], state);
}

/// M at all nodes for the state at the beginning, of which only a feedback takes notice.
bool PanelSolver::sample_all(const Present& now) {
    const std::size_t first = now.M_sampled ? 1 : 0;
    if (now.M_sampled) panel_.samples[0] = now.M;
    if (feedback_) {
        for (std::size_t j = first; j < points; ++j) {
            panel_.samples[j] = sampled(j, now.y);
            if (!std::isfinite(panel_.samples[j])) return bad_at(j);
        }
    } else {
        const bool at_break = panel_.ends == SolvedPanel::End::at_break;
        const std::size_t last = at_break ? points - 1 : points;
        const std::size_t count = last - first;
        spread_.first = first;
        spread_.rests = {&panel_.rests[first], count};
        const std::size_t good =
            excitation_.fill({&panel_.times[first], count}, {&panel_.samples[first], count}, &spread_);
        if (good < count) return bad_at(first + good);
        if (at_break) panel_.samples[points - 1] = excitation_.value_before(panel_.end);
        if (!std::isfinite(panel_.samples[points - 1])) return bad_at(points - 1);
    }
    panel_.M = chebyshev::fit(panel_.samples);
    return true;
}

bool PanelSolver::bad_at(std::size_t node) {
    bad_time_ = panel_.times[node];
    return false;
}

/// M has failed ahead: the run goes on in ever shorter panels until it stands before that time, and ends there.
PanelSolver::Attempt PanelSolver::before_failure() {
    const bool there =
        panel_.start.until(bad_time_) <= std::max(near_failure * pace_, 64 * epsilon * std::fabs(panel_.start.hi));
    if (feedback_) bad_time_ = model::never;
    const bool may_go_on = excitation_.may_go_on() && oscillator_.may_go_on();
    if (!there && may_go_on) return Attempt::shorten;
    return end_with(model::Outcome::excitation_not_finite);
}

PanelSolver::Attempt PanelSolver::stand(const Present& now) {
    steps_.stop = model::never;
    follows_ = false;
    choose(now, model::Motion::stuck);
    if (!sample_all(now)) return before_failure();
    return judge(unresolved_load());
}

/// The motion under this torque (M, or what is not linear in a feedback), from the state at the beginning.
void PanelSolver::solve_for(const Series& torque) {
    const double h = panel_.h, inertia = system_.inertia(), slope = slope_of_line();
    equation_.prepare(h * ((system_.damping() + falls_.velocity + slope) / inertia),
                      h * (h * ((system_.stiffness() + falls_.theta) / inertia)));
    const double scale = h * (h / inertia);
    Series r{};
    for (std::size_t k = 1; k < points; ++k) r[k] = scale * torque[k];
    const double sign = model::sign_of(panel_.motion);
    const double friction = panel_.friction.straight ? sign * panel_.friction.at(sign * panel_.begin.velocity)
                                                     : system_.braking(panel_.motion);
    const double k = system_.stiffness();
    r[0] = scale * ((std::fma(-k, panel_.begin.theta, torque[0]) - friction) - k * theta_rest_);
    panel_.w = equation_.solve(r, h * panel_.begin.velocity, h * (slope / inertia));
    panel_.v = chebyshev::integral(panel_.w, h * panel_.begin.velocity);
    panel_.p = chebyshev::integral(panel_.v, 0.0);
}

PanelSolver::Attempt PanelSolver::move(const Present& now, model::Motion way, const model::State& departing) {
    theta_rest_ = now.theta_rest;
    if (slide_.inside()) foresee_friction(now, way);
    follows_ = !feedback_ && slide_.has_corners() && slide_.line() == nullptr;
    if (feedback_) {
        go_on_from(now, way);
        steps_.strides = false;
        if (stride(now, way, departing)) return accept();
        const auto is_here = [&] {
            return std::fabs(now.clock.until(steps_.stop)) <= 8 * epsilon * std::fabs(now.clock.hi);
        };
        const bool arrived = is_here(), near = steps_.part == 1;
        if (arrived) steps_.part = 1;
        if (arrived && near && cross_step(now, way, departing)) return accept();
        if (arrived && !near) h_ = std::min(h_, 2 * steps_.left);
        if (!foresee(now, way, departing)) return judge(std::numeric_limits<double>::infinity());
        if (is_here()) {
            if (cross_step(now, way, departing)) return accept();
            choose(now, way);
        }
        switch (iterate(departing)) {
            case Iteration::failed:
                // Perhaps for a state that only the iteration has been in: a shorter panel will tell.
                h_ = panel_.h / 2;
                bad_time_ = panel_.start.after(panel_.h);
                return before_failure();
            case Iteration::diverges:
                return judge(std::numeric_limits<double>::infinity());
            case Iteration::converged:
                break;
        }
    } else {
        choose(now, way);
        if (!sample_all(now)) return before_failure();
        if (!follows_) {
            falls_.velocity = 0;
            solve_for(panel_.M);
        } else if (!follow_friction(now)) {
            return judge(std::numeric_limits<double>::infinity());
        }
    }
    if (!within_range()) return end_with(model::Outcome::state_not_finite);
    return judge(feedback_ ? unresolved_motion() : std::max(unresolved_load(), unresolved_motion()));
}

/// Whether the motion on the panel, its torques, and the bounds that prove its events are numbers.
bool PanelSolver::within_range() const {
    constexpr double largest = std::numeric_limits<double>::max() / 1e7;  // chebyshev::derivative_bound takes 2e6
    const double farthest = std::fabs(panel_.begin.theta) + chebyshev::size(panel_.p),
                 fastest = chebyshev::size(panel_.v) / panel_.h;
    const auto fits = [](double x) { return x < largest; };
    return fits(farthest) && fits(system_.stiffness() * farthest) && fits(fastest) &&
           fits(system_.damping() * fastest) && fits(chebyshev::size(panel_.v)) && fits(chebyshev::size(panel_.w));
}

}  // namespace dinal::motion::spectral
