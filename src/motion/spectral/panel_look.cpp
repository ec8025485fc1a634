// What M does between the nodes of a panel, and whether it is rough on every scale.
#include <algorithm>
#include <array>
#include <cmath>

#include "motion/roughness.hpp"
#include "motion/spectral/corner_look.hpp"
#include "motion/spectral/panel_solver.hpp"

namespace dinal::motion::spectral {

namespace {

/// The widest gaps between nodes, by the node before: in the middle of these M is asked once more.
constexpr std::array<std::size_t, 3> looked_into{7, 8, 9};
/// The widest gap that is left, as a part of the panel.
constexpr double widest_left = (chebyshev::nodes[7] - chebyshev::nodes[6]) / 2;
static_assert(widest_left < chebyshev::widest_gap);
/// On panels shorter than this, in units of pace_, nothing hides.
constexpr double too_short_to_look = 1e-6;
/// By so much more than its error M must miss its series.
constexpr double clearly_off = 64;

}  // namespace

double PanelSolver::gap() const {
    if (!script_) return 0;
    if (steps_.strides) return panel_.h;
    const bool looks = 2 * panel_.h > too_short_to_look * pace_;
    return 2 * panel_.h * (looks ? widest_left : chebyshev::widest_gap);
}

/// Asks M between the nodes of a panel that seems to be resolved. A pulse may be there that no node has met.
PanelSolver::Look PanelSolver::look_between() {
    if (2 * panel_.h <= too_short_to_look * pace_) return Look::agrees;
    constexpr std::size_t most_looks = looked_into.size() + 1;
    const bool moves = panel_.motion != model::Motion::stuck, of_time = !feedback_ || !moves;
    std::array<double, most_looks> places{}, looks{}, found{};
    std::size_t wanted = 0;
    if (panel_.start.until(seen_) > 0 && seen_ < panel_.end) places[wanted++] = panel_.x(seen_);
    for (const std::size_t j : looked_into) places[wanted++] = (chebyshev::nodes[j] + chebyshev::nodes[j + 1]) / 2;
    for (std::size_t i = 0; i < wanted; ++i) looks[i] = panel_.time(places[i]);
    if (!feedback_) {  // the way into the user's language is paid once for all
        const std::size_t good = excitation_.fill({looks.data(), wanted}, {found.data(), wanted});
        if (good < wanted) {
            bad_time_ = looks[good];
            return Look::failed;
        }
    }
    double most = 0, where = 0;
    for (std::size_t i = 0; i < wanted; ++i) {
        if (feedback_) found[i] = excitation_.value(looks[i], moves ? state_at(places[i]) : panel_.begin);
        const double off = std::fabs(found[i] - chebyshev::value(panel_.M, places[i]));
        if (!(off <= most)) most = off, where = looks[i];
        if (std::isfinite(off)) continue;
        bad_time_ = where;
        return Look::failed;
    }
    double allowed = (tolerance_ + 4 * epsilon) * torques() + noise_;
    if (most <= clearly_off * allowed) return Look::agrees;
    allowed += lost_in_time();
    if (!of_time) {
        const double per_torque = panel_.h * (panel_.h / system_.inertia());
        const double motion = std::max(chebyshev::size(panel_.v), chebyshev::size(panel_.w));
        allowed += (tolerance_ * motion + rounding_of_motion(lost_in_time())) / per_torque;
    }
    if (most <= clearly_off * allowed) return Look::agrees;
    seen_ = where;
    h_ = panel_.h / 2;
    if (!of_time || !found_breaks_.empty()) return Look::differs;
    // All that is known of M, in order of time.
    std::array<double, points + most_looks> times{}, values{};
    std::copy(panel_.times.begin(), panel_.times.end(), times.begin());
    std::copy(panel_.samples.begin(), panel_.samples.end(), values.begin());
    std::size_t count = points;
    for (std::size_t i = 0; i < wanted; ++i, ++count) {
        std::size_t place = count;
        for (; place > 0 && times[place - 1] > looks[i]; --place) {
            times[place] = times[place - 1], values[place] = values[place - 1];
        }
        times[place] = looks[i], values[place] = found[i];
    }
    find_break_among(std::span(times).first(count), std::span(values).first(count));
    return Look::differs;
}

/// Asks friction and springs where no node is.
PanelSolver::Look PanelSolver::look_at_corners() {
    if (2 * panel_.h <= too_short_to_look * pace_) return Look::agrees;
    const double h = panel_.h, per_torque = h * (h / system_.inertia());
    const auto w = chebyshev::at_nodes(panel_.w), M = chebyshev::at_nodes(panel_.M);
    CornerLook look{system_, slide_, panel_.motion, chebyshev::at_nodes(panel_.p), chebyshev::at_nodes(panel_.v), {}};
    for (std::size_t j = 0; j < points; ++j) {
        look.theta[j] += panel_.begin.theta, look.slip[j] /= h;
        look.remainder[j] = M[j] - system_.braking(panel_.motion) - system_.damping() * look.slip[j] -
                            system_.stiffness() * look.theta[j] - w[j] / per_torque;
    }
    const double motion = std::max(chebyshev::size(panel_.v), chebyshev::size(panel_.w)), lost = lost_in_time();
    const double allowed = (tolerance_ + 4 * epsilon) * torques() + noise_ + lost +
                           (tolerance_ * motion + rounding_of_motion(lost)) / per_torque;
    const auto missed = missed_corner(look, clearly_off * allowed);
    if (!missed) return Look::agrees;
    h_ = panel_.h * shorter_by_corner(*missed);
    return Look::differs;
}

/// The panel is tried again, shorter.
PanelSolver::Attempt PanelSolver::looked(Look look) {
    if (look == Look::failed) return before_failure();
    return crawls() ? end_with(never_ending()) : Attempt::shorten;
}

/// A panel that was made shorter, and M is no smoother on it: noise, if M is as rough on stretches far shorter still,
/// at one place as at another. (A jump is only at one.) From then on M need not be smoother than that.
bool PanelSolver::found_noise() {
    if (!(unresolved_load() > 1)) return false;  // the motion is what is too quick for the panel
    const double tail = chebyshev::tail(panel_.M);
    const auto before = stalled_;
    stalled_ = {panel_.start.hi, panel_.h, tail};
    const bool of_motion = feedback_ && panel_.motion != model::Motion::stuck;
    const double most_tail = of_motion ? most_noise_of_motion * chebyshev::size(panel_.M) : most_noise * torques();
    if (!(tail <= most_tail)) return false;
    constexpr double varies = 8;
    if (noise_ > 0 && tail <= varies * noise_) {
        noise_ = 2 * tail;
        return true;
    }
    const bool stalled = before.from == panel_.start.hi && panel_.h < 0.95 * before.h && tail > 0.3 * before.tail;
    if (!stalled) return false;
    const auto M = [&](double t) { return excitation_.value(t, of_motion ? state_at(panel_.x(t)) : panel_.begin); };
    const std::array<double, 3> starts{panel_.time(-0.9), panel_.time(0.1), panel_.time(0.8)};
    const Roughness rough = roughness(M, starts, rough_stretch * 2 * panel_.h);
    if (!(rough.usual > tail / 10)) return false;
    constexpr double above = 3;  // of two coefficients, what others may be
    noise_ = above * std::max(tail, rough.most);
    return true;
}

}  // namespace dinal::motion::spectral
