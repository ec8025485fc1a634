#include "motion/engine/flow.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/break_search.hpp"
#include "motion/interpolation.hpp"

namespace dinal::motion::engine {

namespace {

constexpr double roundings_shown = 16;  // a series of a formula's values may show this multiple of their rounding

constexpr double gross = 1e3;  // a stretch unresolved by more than this factor may contain a break
/// The nodes before the widest gaps. Users' functions are also sampled in the middle of these.
constexpr std::array<std::size_t, 3> looked_into{7, 8, 9};
/// A fraction of the longest stretch: a shorter one cannot hide a pulse.
constexpr double too_short_to_look = 1e-6;

}  // namespace

Flow::Flow(const Mechanics& mechanics, double tolerance, double longest)
    : mechanics_(mechanics),
      tolerance_(tolerance),
      longest_(longest),
      n_(mechanics.bodies()),
      m_(mechanics.states()),
      noise_(mechanics),
      newton_(mechanics),
      allowed_(n_),
      proofs_(mechanics) {
    sizes_.all.resize(n_), fastest_.belts.resize(mechanics.joints()), fastest_.rates.resize(m_), room_.rate.resize(m_);
    for (auto* of : {&offsets_.velocities, &offsets_.rates, &offsets_.ways}) of->resize(n_);
    mechanics.for_each_signal([this](const Signal& s) { takes_rests_ = takes_rests_ && s.takes_rests(); });
}

Flow::Attempt Flow::solve(Segment& s, const Mode& mode, const Frame& frame, const std::vector<double>& begin,
                          const std::vector<double>& departing) {
    unresolved_ = std::numeric_limits<double>::infinity();
    strayed_ = false;
    note_rates_until(s.start.hi, s);
    if (!sample(s, mode, frame, begin)) return Attempt::failed;
    sizes_.at_start.find(mechanics_, s, {s.times[0], s.side(0), begin});
    const Attempt attempt = find(s, mode, frame, departing);
    const std::size_t groups = frame.groups();
    if (attempt != Attempt::resolved) {
        // The unresolved rates may be noise, so they are kept for its detection.
        for (std::size_t k = 0; k < m_; ++k) s.f[2 * n_ + k] = found_[groups + k];
        return attempt;
    }
    for (std::size_t i = 0; i < n_; ++i) {
        Nodes rates = offsets_.rates[i];
        for (const auto& [group, by] : frame.bodies[i]) add(rates, unknown_[group], by);
        s.f[n_ + i] = rates;
    }
    for (std::size_t k = 0; k < m_; ++k) s.f[2 * n_ + k] = unknown_[groups + k];
    fit_series(s, frame, begin);
    for (const Series& series : s.series) {
        if (!std::isfinite(cheb::size(series))) return Attempt::failed;
    }
    find_holding(s, mode, frame);
    find_limits(s, mode);
    return accept(s, mode, frame);
}

/// Updates the greatest rates of states by those of the last stretch up to its end. Rates after that time, and those of
/// a failed attempt, did not act.
void Flow::note_rates_until(double end, const Segment& s) {
    for (std::size_t k = 0; k < m_ && !s.f.empty(); ++k) {
        for (std::size_t j = 0; j < node_count && s.times[j] <= end; ++j) {
            fastest_.rates[k] = std::max(fastest_.rates[k], std::fabs(s.f[2 * n_ + k][j]));
        }
    }
}

bool Flow::is_dwarfed_beyond(double x, const Segment& s) const {
    constexpr double dwarfs = 1e3;
    for (std::size_t k = n_; k < s.f.size(); ++k) {
        double before = 0, beyond = 0;
        for (std::size_t j = 0; j < node_count; ++j) {
            double& greatest = cheb::nodes[j] <= x ? before : beyond;
            greatest = std::max(greatest, std::fabs(s.f[k][j]));
        }
        if (beyond > dwarfs * before) return true;
    }
    return false;
}

/// Checks that no function has a feature between the nodes that its values there do not show.
Flow::Attempt Flow::look_between(Segment& s, const Mode& mode, const Frame& frame) {
    if (unresolved_ <= 1 && !agrees_between(s, mode, frame)) unresolved_ = 2;
    if (unresolved_ <= 1 && !hides_nothing(s, mode, 1)) unresolved_ = 2;
    if (unresolved_ > 1) return Attempt::shorten;
    noise_.note_resolved(s);
    for (const Signal& load : mechanics_.loads()) load.keep(s, tolerance_);
    return Attempt::resolved;
}

bool Flow::hides_nothing(Segment& s, const Mode& mode, double until) {
    const Proofs::Beside beside{tolerance_, sizes_.all, noise_.floor(), fastest_.belts, fastest_.rates};
    return proofs_.hides_nothing(s, mode, beside, until);
}

bool Flow::hides_nothing_until(double x, Segment& s, const Mode& mode) {
    if (s.proven || !(x < 1)) return true;
    s.proven = true;
    if (!(x > -1) || hides_nothing(s, mode, x)) return true;
    unresolved_ = 2;
    return false;
}

void Flow::make_room(Segment& s) const {
    if (!s.y.empty()) return;
    for (auto of : {&Segment::y, &Segment::f, &Segment::series, &Segment::rates}) (s.*of).resize(2 * n_ + m_);
    for (auto of : {&Segment::moved, &Segment::torques}) (s.*of).resize(n_);
    for (auto of : {&Segment::loads, &Segment::driven, &Segment::belts, &Segment::belt_rates, &Segment::holding})
        (s.*of).resize(mechanics_.joints());
    s.holding_series.resize(mechanics_.joints());
}

/// Returns whether the torque of a sticking joint is compared with a limit, or moves the body by a belt. It must then
/// be as accurate as the motion.
bool Flow::is_compared(std::size_t joint, const Mode& mode) const {
    return mode.holds(joint) && (mode.rigid[joint] == 0 || mechanics_.has_belt(joint));
}

/// Evaluates everything that depends on time alone. Returns false if a user's function has failed.
bool Flow::sample(Segment& s, const Mode& mode, const Frame& frame, const std::vector<double>& begin) {
    const std::size_t joints = mechanics_.joints();
    make_room(s);
    for (Nodes& way : s.moved) way.fill(0);
    const Clock start = s.start;
    for (std::size_t j = 0; j + 1 < node_count; ++j) s.times[j] = start.after(s.h * (1 + cheb::nodes[j]));
    s.times[node_count - 1] = s.end;
    for (std::size_t j = 0; j < node_count; ++j) {
        s.rests[j] = s.h * (1 + cheb::nodes[j]) - start.until(s.times[j]);
    }
    for (std::size_t k = 0; k < s.y.size(); ++k) s.y[k].fill(begin[k]);
    mechanics_.sample_loads(s, s.loads);
    s.driven = s.loads;
    std::size_t good = node_count;
    for (const Nodes& load : s.loads) {
        if (cheb::sum_of<node_count>([&](std::size_t j) { return 0 * load[j]; }) == 0) continue;
        const auto* const bad = std::find_if(load.begin(), load.end(), [](double M) { return !std::isfinite(M); });
        good = std::min(good, static_cast<std::size_t>(bad - load.begin()));
    }
    if (good < node_count) {
        bad_time_ = s.times[good];
        return false;
    }
    if (!mechanics_.has_belts()) return true;
    for (std::size_t i = 0; i < n_; ++i) offsets_.velocities[i] = {}, offsets_.rates[i] = {}, offsets_.ways[i] = {};
    for (std::size_t joint = 0; joint < joints; ++joint) {
        s.belts[joint] = s.belt_rates[joint] = {};
        if (!mechanics_.has_belt(joint)) continue;
        for (std::size_t j = 0; j < node_count; ++j) {
            s.belts[joint][j] = mechanics_.belt(joint, s.times[j], s.side(j));
            if (std::isfinite(s.belts[joint][j])) continue;
            bad_time_ = s.times[j];
            return false;
        }
        fastest_.belts[joint] = std::max(fastest_.belts[joint], greatest(s.belts[joint]));
        // On such a short segment the belt's values do not determine its slope.
        constexpr double too_short_for_slopes = 1e-7, stretch = 1e-4;
        if (2 * s.h < too_short_for_slopes * longest_) {
            const double within = std::min(stretch * longest_, (mechanics_.next_break(s.start.hi) - s.start.hi) / 2);
            s.belt_rates[joint].fill(mechanics_.belt_slope(joint, s.start.hi, within).rate);
            continue;
        }
        const auto slope = cheb::derivative(cheb::fit(s.belts[joint]));
        for (std::size_t j = 0; j < node_count; ++j) s.belt_rates[joint][j] = cheb::value(slope, cheb::nodes[j]) / s.h;
    }
    if (frame.edges.empty()) return true;
    room_.belt.resize(joints);
    for (std::size_t j = 0; j < node_count; ++j) {
        for (std::size_t joint = 0; joint < joints; ++joint) room_.belt[joint] = s.belts[joint][j];
        frame.offsets(room_.belt, mode, room_.torque);
        for (std::size_t i = 0; i < n_; ++i) offsets_.velocities[i][j] = room_.torque[i];
        for (std::size_t joint = 0; joint < joints; ++joint) room_.belt[joint] = s.belt_rates[joint][j];
        frame.offsets(room_.belt, mode, room_.torque);
        for (std::size_t i = 0; i < n_; ++i) offsets_.rates[i][j] = room_.torque[i];
    }
    for (std::size_t i = 0; i < n_; ++i) integrate(offsets_.velocities[i], s.h, offsets_.ways[i]);
    return true;
}

bool Flow::evaluate(Segment& s, const Mode& mode, const Frame& frame, std::size_t first, std::size_t end,
                    const std::vector<double>* departing) {
    bool good = true;
    bool placed = false;
    const auto each_node = [&](auto&& at_node) {
        for (std::size_t j = first; j < end && !placed; ++j) {
            room_.points[j].resize(s.y.size());
            for (std::size_t k = 0; k < s.y.size(); ++k) room_.points[j][k] = departing ? (*departing)[k] : s.y[k][j];
        }
        placed = true;
        for (std::size_t j = first; j < end; ++j) at_node(j, Moment{s.times[j], s.side(j), room_.points[j]});
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        std::copy(s.loads[i].data() + first, s.loads[i].data() + end, s.driven[i].data() + first);
        const Signal& load = mechanics_.loads()[i];
        if (load.depends_on_motion()) {
            each_node([&](std::size_t j, const Moment& at) { s.driven[i][j] += load.of_motion(at); });
        }
        if (i < n_) std::copy(s.driven[i].data() + first, s.driven[i].data() + end, s.torques[i].data() + first);
    }
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        const model::Joint& own = mechanics_.system().joints[joint];
        Nodes torque;
        if (mechanics_.is_native(joint) && mode.leans[joint] == 0 && !mechanics_.spring_slides(joint)) {
            mechanics_.native_torques(joint, mode, s.y, s.belts[joint], first, end, torque);
        } else {
            each_node([&](std::size_t j, const Moment& at) {
                torque[j] = mechanics_.joint_torque(joint, at, mode, s.belts[joint][j]);
            });
        }
        // The stiffness acts on the unrounded displacement.
        for (const auto& [body, by] : own.of) {
            const double k = by * own.stiffness;
            if (k == 0) continue;
            const Nodes &y = s.y[body], &moved = s.moved[body];
            const double low = s.low[body];
            for (std::size_t j = first; j < end; ++j) torque[j] += k * (low + (moved[j] - (y[j] - y[0])));
        }
        for (std::size_t j = first; j < end && joint >= n_; ++j) torque[j] -= s.driven[joint][j];
        for (const auto& [body, by] : own.of) {
            Nodes& on_body = s.torques[body];
            for (std::size_t j = first; j < end; ++j) on_body[j] -= by * torque[j];
        }
    }
    for (std::size_t g = 0; g < frame.groups(); ++g) std::fill(found_[g].data() + first, found_[g].data() + end, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
        const Nodes& torque = s.torques[i];
        double sum = 0;
        for (std::size_t j = first; j < end; ++j) sum += torque[j];
        good = good && std::isfinite(sum);
        const double inertia = mechanics_.system().bodies[i].inertia;
        for (const auto& [group, by] : frame.bodies[i]) {
            Nodes& found = found_[group];
            const double share = by / frame.inertia[group];
            for (std::size_t j = first; j < end; ++j) found[j] += share * (torque[j] - inertia * offsets_.rates[i][j]);
        }
    }
    if (m_ > 0) {
        each_node([&](std::size_t j, const Moment& at) {
            mechanics_.rates(at, room_.rate.data(), &mode);
            for (std::size_t k = 0; k < m_; ++k) {
                found_[frame.groups() + k][j] = room_.rate[k];
                good = good && std::isfinite(room_.rate[k]);
            }
        });
    }
    for (std::size_t j = first; j < end && !good; ++j) {
        bool here = true;
        for (std::size_t i = 0; i < n_; ++i) here = here && std::isfinite(s.torques[i][j]);
        for (std::size_t k = 0; k < m_; ++k) here = here && std::isfinite(found_[frame.groups() + k][j]);
        bad_time_ = s.times[j];
        if (!here) break;
    }
    return good;
}

double Flow::size_at(std::size_t joint) const {
    double size = 0;
    for (const auto& [body, by] : mechanics_.system().joints[joint].of) {
        size = std::max(size, sizes_.all[body] / std::fabs(by));
    }
    return size;
}

void Flow::find_sizes(const Segment& s) {
    for (std::size_t i = 0; i < n_; ++i) sizes_.all[i] = sizes_.at_start.on_body(i) + greatest(s.torques[i]);
}

/// Fits the series of the motion by integrating those of the accelerations, which is cheaper than a fit of velocities
/// and angles. Terms beyond degree 16 are folded onto the terms that are equal at the nodes.
void Flow::fit_series(Segment& s, const Frame& frame, const std::vector<double>& begin) {
    const bool integrated = follows_rates() && !mechanics_.has_belts();
    if (integrated && unknown_.empty()) {  // nothing moves
        for (std::size_t k = 0; k < s.y.size(); ++k) s.rates[k] = s.series[k] = {};
        return;
    }
    for (std::size_t k = n_; k < s.f.size(); ++k) s.rates[k] = cheb::fit(s.f[k]);
    for (std::size_t i = 0; i < n_ && integrated; ++i) {
        auto w = s.rates[n_ + i];
        for (double& c : w) c *= s.h;
        auto v = cheb::integral(w, 0.0);
        s.series[n_ + i] = cheb::folded(v);
        v[0] += begin[n_ + i];
        for (double& c : v) c *= s.h;
        s.series[i] = frame.bodies[i].empty() ? Series{} : cheb::folded(cheb::integral(v, 0.0));
    }
    for (std::size_t k = integrated ? 2 * n_ : 0; k < s.y.size(); ++k) {
        Nodes change{};
        for (std::size_t j = 0; j < node_count; ++j) change[j] = k < n_ ? s.moved[k][j] : s.y[k][j] - begin[k];
        s.series[k] = cheb::fit(change);
    }
}

/// Computes the torques of sticking joints, and the series of those that are compared with a limit.
void Flow::find_holding(Segment& s, const Mode& mode, const Frame& frame) {
    if (frame.edges.empty()) return;
    room_.lacking.resize(n_);
    for (std::size_t i = 0; i < n_; ++i) {
        const double inertia = mechanics_.system().bodies[i].inertia;
        for (std::size_t j = 0; j < node_count; ++j) {
            room_.lacking[i][j] = inertia * s.f[n_ + i][j] - s.torques[i][j];
        }
    }
    frame.multipliers(room_.lacking, s.holding);
    for (std::size_t joint = 0; joint < s.holding.size(); ++joint) {
        if (is_compared(joint, mode)) s.holding_series[joint] = cheb::fit(s.holding[joint]);
    }
}

namespace {

/// Returns the factor by which a stretch with this series may be longer and still be resolved. The estimate uses the
/// average decay of the coefficients down to `allowed`, or the last coefficients if these permit more.
double longer_by(const Series& series, double allowed) {
    std::size_t d = cheb::degree;
    while (d > 1 && std::fabs(series[d - 1]) <= allowed) --d;
    const double size = cheb::size(series), tail = std::max(cheb::tail(series), 1e-16 * allowed);
    const double by_decay =
        size > allowed ? std::pow(size / allowed, 1.0 / static_cast<double>(d) - 1.0 / cheb::degree) : model::never;
    return std::max(by_decay, std::pow(allowed / tail, 1.0 / cheb::degree));
}

/// Returns the greatest |t| of a stretch.
double latest_time(const Segment& s) {
    return std::max(std::fabs(s.start.hi), std::fabs(s.end));
}

double of_others(const std::vector<double>& by_others, std::size_t k) {
    return by_others.empty() ? 0 : by_others[k];
}

}  // namespace

double Flow::noise_of_torques(const Segment& s) const {
    const double of_share = s.slides ? 16 * rounding * *std::max_element(sizes_.all.begin(), sizes_.all.end()) : 0;
    return noise_.of_torques() + of_share;
}

/// Returns the noise that acts on each group and state through the quantities it depends on, times h; empty without
/// noise.
std::vector<double> Flow::passed_on(const Segment& s, const Frame& frame) const {
    const std::size_t groups = frame.groups(), count = groups + m_;
    const std::vector<double>& noise = noise_.floor().noise;
    const bool none = std::all_of(noise.begin(), noise.end(), [](double x) { return x == 0; });
    if (none && !s.slides) return {};
    const Eigen::MatrixXd* const slopes = newton_.slopes(frame);
    if (slopes == nullptr) return {};
    std::vector<double> rough(count);
    Eigen::VectorXd off(static_cast<Eigen::Index>(count));
    for (std::size_t k = 0; k < count; ++k) {
        off(static_cast<Eigen::Index>(k)) =
            s.h * (k < groups ? noise_of_torques(s) / frame.inertia[k] : noise_.floor().noise[n_ + (k - groups)]);
    }
    const Eigen::MatrixXd by = slopes->rightCols(static_cast<Eigen::Index>(count)).cwiseAbs();
    const Eigen::VectorXd once = by * off, twice = once + s.h * (by * once);
    for (std::size_t k = 0; k < count; ++k) rough[k] = s.h * twice(static_cast<Eigen::Index>(k));
    return rough;
}

/// Returns the possible error of a belt's velocity due to the rounding of times far from t = 0 and, if its series has
/// not decayed, to that of its formulas.
double Flow::lost_by_belt(const Segment& s, std::size_t joint, const Series& belt) {
    const double fastest = fastest_.belts[joint], lost = lost_in_time(belt, latest_time(s), s.h, fastest);
    const bool ends_high = cheb::tail(belt) > lost + 16 * rounding * fastest;
    return lost + (ends_high ? roundings_shown * proofs_.rounding_of_belt(s, joint) : 0);
}

/// Compares the last coefficients of each acceleration and rate with the allowed error.
void Flow::judge(const Segment& s, const Mode& mode, const Frame& frame) {
    unresolved_ = 0, growth_ = model::never;
    allowed_.assign(n_, 0);
    find_sizes(s);
    fastest_.lost_by_belts = 0;
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        if (!mechanics_.has_belt(joint)) continue;
        fastest_.lost_by_belts = std::max(fastest_.lost_by_belts, lost_by_belt(s, joint, cheb::fit(s.belts[joint])));
    }
    const std::vector<double> by_others = passed_on(s, frame);
    judge_bodies(s, mode, frame, by_others);
    judge_joints(s, mode);
    judge_states(s, frame, by_others);
}

void Flow::note_error(const Segment& s, const Series& series, double scale, double allowed) {
    unresolved_ = std::max(unresolved_, scale * cheb::tail(series) / allowed);
    if (s.may_grow) growth_ = std::min(growth_, longer_by(series, allowed / scale));
}

/// Returns the possible error of the torques on a body due to the rounding of times far from t = 0: of its loads, and
/// of friction that changes in time.
double Flow::lost_of_torques(const Segment& s, std::size_t body) const {
    double sum = 0;
    bool friction_changes = false;
    for (std::size_t j = 0; j < mechanics_.joints() && !takes_rests_; ++j) {
        const model::Joint& joint = mechanics_.system().joints[j];
        const bool acts = j == body || (!mechanics_.loads()[j].none() && joint.is_on(body));
        if (acts) sum += lost_in_time(cheb::fit(s.loads[j]), latest_time(s), s.h, sizes_.all[body]);
        const model::ContactFriction& rubs = joint.friction;
        const bool of_time = rubs.normal || rubs.function != nullptr || rubs.sliding[0] || rubs.sliding[1];
        friction_changes = friction_changes || (of_time && joint.is_on(body));
    }
    if (friction_changes) sum += lost_in_time(cheb::fit(s.torques[body]), latest_time(s), s.h, sizes_.all[body]);
    return sum;
}

void Flow::judge_bodies(const Segment& s, const Mode& mode, const Frame& frame, const std::vector<double>& by_others) {
    const double h = s.h;
    for (std::size_t i = 0; i < n_; ++i) {
        const double torques = sizes_.all[i];
        if (const Frame::Shape& shape = frame.bodies[i]; !shape.empty()) {
            double per_torque = 0, others = 0;
            for (const auto& [group, by] : shape) {
                per_torque += h * by * by / frame.inertia[group], others += std::fabs(by) * of_others(by_others, group);
            }
            const Series& series = s.rates[n_ + i];
            const double size = h * cheb::size(series), tail = h * cheb::tail(series);
            double allowed = tolerance_ * std::max(greatest(s.y[n_ + i]), size) +
                             64 * rounding * (size + per_torque * torques) + smallest / h;
            if (tail > allowed || mechanics_.nonlinear()) allowed += per_torque * lost_of_torques(s, i);
            if (tail > allowed && !frame.edges.empty()) allowed += blurred_velocity();  // held on belts
            allowed += per_torque * noise_.of_torques() + others;
            note_error(s, series, h, allowed);
            allowed_[i] = allowed / h;
        } else if (n_ > 1 || !is_compared(0, mode)) {  // otherwise the joint's torques are checked instead
            const Series series = cheb::fit(s.torques[i]);
            double allowed = (tolerance_ + 16 * rounding) * torques + noise_.of_torques() + smallest;
            if (cheb::tail(series) > allowed) allowed += lost_of_torques(s, i);
            note_error(s, series, 1, allowed);
        }
    }
}

void Flow::judge_joints(const Segment& s, const Mode& mode) {
    double held = 0;  // torque that rigid joints and walls transmit
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        if (mode.keeps_place(joint)) held = std::max(held, greatest(s.holding[joint]));
    }
    for (std::size_t joint = 0; joint < mechanics_.joints(); ++joint) {
        if (is_compared(joint, mode)) {
            const Series& series = s.holding_series[joint];
            const double torques = std::max(size_at(joint), held),
                         lost = (takes_rests_ ? 0 : lost_in_time(series, latest_time(s), s.h, torques)) +
                                noise_.of_torques();
            note_error(s, series, 1, (tolerance_ + 64 * rounding) * torques + lost + blurred_by_belts(s) + smallest);
            for (std::size_t way = 0; way < 2 && mechanics_.limits_change(joint, mode); ++way) {
                const Series limit = cheb::fit(s.limits[joint][way]);
                // the limit is compared with these torques
                const double most = greatest(s.limits[joint][way]) + torques;
                double allowed =
                    (tolerance_ + 64 * rounding) * most + lost_in_time(limit, latest_time(s), s.h, most) + smallest;
                if (cheb::tail(limit) > allowed) allowed += roundings_shown * proofs_.rounding_of_limit(s, mode, joint);
                note_error(s, limit, 1, allowed);
            }
        }
        if (!mechanics_.has_belt(joint)) continue;
        const Series belt = cheb::fit(s.belts[joint]);
        const double allowed = (tolerance_ + 16 * rounding) * greatest(s.belts[joint]) +
                               16 * rounding * fastest_.belts[joint] + lost_by_belt(s, joint, belt) + smallest;
        note_error(s, belt, 1, allowed);
    }
}

void Flow::judge_states(const Segment& s, const Frame& frame, const std::vector<double>& by_others) {
    const double h = s.h;
    double rough = 0;  // relative noise of M, which also makes the states rough
    for (std::size_t i = 0; i < n_; ++i) {
        rough =
            std::max(rough, noise_.floor().noise[i] / (std::max(sizes_.all[i], noise_.floor().greatest[i]) + smallest));
    }
    for (std::size_t k = 0; k < m_; ++k) {
        Series series = s.rates[2 * n_ + k];
        for (double& c : series) c *= h;
        const double fastest = std::max(fastest_.rates[k], greatest(s.f[2 * n_ + k]));
        const double allowed =
            (tolerance_ + rough + 64 * rounding) * std::max(greatest(s.y[2 * n_ + k]), cheb::size(series)) +
            64 * rounding * h * fastest + lost_in_time(series, latest_time(s), h, h * fastest) +
            h * noise_.floor().noise[n_ + k] + of_others(by_others, frame.groups() + k);
        note_error(s, series, 1, allowed + smallest);
    }
}

void Flow::find_limits(Segment& s, const Mode& mode) const {
    s.limits.resize(mechanics_.joints());
    std::vector<double> y;
    for (std::size_t joint = 0; joint < s.limits.size(); ++joint) {
        if (!mechanics_.limits_change(joint, mode)) continue;
        for (std::size_t j = 0; j < node_count; ++j) {
            const Moment at = s.moment(j, y);
            s.limits[joint][0][j] = mechanics_.limit_at_rest(joint, mode, model::Motion::backward, at);
            s.limits[joint][1][j] = mechanics_.limit_at_rest(joint, mode, model::Motion::forward, at);
        }
    }
}

double Flow::blurred_by_belts(const Segment& s) const {
    double inertia = 0;
    for (const model::Body& body : mechanics_.system().bodies) inertia += body.inertia;
    return inertia * blurred_velocity() / s.h;
}

double Flow::blurred_velocity() const {
    if (!mechanics_.has_belts()) return 0;
    double fastest = 0;
    for (const double belt : fastest_.belts) fastest = std::max(fastest, belt);
    return 256 * rounding * fastest + fastest_.lost_by_belts;
}

/// Adds points just before a body turns, where a spring or friction law may act for a very short time only.
void Flow::add_turns(const Segment& s, std::vector<double>& places) const {
    constexpr double before = 1e-9;
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const model::Joint& joint = mechanics_.system().joints[i];
        const model::Friction& law = joint.friction.law;
        const bool users = joint.friction.function != nullptr ||
                           (joint.friction.bending() == nullptr && law.depends_on_speed() && law.ranges() == 0);
        if (joint.spring.none() && !users) continue;
        const Nodes velocity = mechanics_.slips(i, s.y, users ? s.belts[i] : Nodes{});
        const Series series = cheb::fit(velocity);
        for (std::size_t j = 0; j + 1 < node_count; ++j) {
            if (!(velocity[j] * velocity[j + 1] < 0)) continue;
            const double sign = velocity[j + 1] > 0 ? 1 : -1;
            const auto rising = [&](double x) { return sign * cheb::value(series, x); };
            places.push_back(first_positive(rising, cheb::nodes[j], sign * velocity[j], cheb::nodes[j + 1],
                                            sign * velocity[j + 1], before / 4)
                                 .first -
                             before);
            if (!joint.friction.none()) break;  // beyond a stop the motion is different
        }
    }
}

double Flow::gap(const Segment& s) const {
    constexpr double widest_left = (cheb::nodes[7] - cheb::nodes[6]) / 2;
    return 2 * s.h * (2 * s.h > too_short_to_look * longest_ ? widest_left : cheb::widest_gap);
}

/// Compares functions and laws with their polynomials between the nodes, to find a pulse or corner that no node shows.
bool Flow::agrees_between(const Segment& s, const Mode& mode, const Frame& frame) {
    constexpr double clearly = 64;
    if (2 * s.h <= too_short_to_look * longest_) return true;
    const bool seen = s.start.until(proofs_.seen()) > 0 && proofs_.seen() < s.end;
    const bool scripts = std::any_of(mechanics_.loads().begin(), mechanics_.loads().end(), [&](const Signal& load) {
        return load.changes_in_time() && (seen || proofs_.failed_last() || !load.is_read());
    });
    if (!scripts && !mechanics_.nonlinear()) return true;
    std::vector<Series> loads(mechanics_.joints());
    std::vector<Series> accelerations(mechanics_.nonlinear() ? n_ : 0);
    for (std::size_t i = 0; i < loads.size(); ++i) loads[i] = cheb::fit(s.loads[i]);
    for (std::size_t i = 0; i < accelerations.size(); ++i) accelerations[i] = s.rates[n_ + i];
    std::vector<double> y, belts(mechanics_.joints()), torques;
    std::vector<double> places;
    // Up to this time functions are known by the series of the last stretch, which was sampled between its nodes.
    double looked = seen || mechanics_.nonlinear() ? -model::never : model::never;
    for (const Signal& load : mechanics_.loads()) {
        if (load.changes_in_time()) looked = std::min(looked, load.kept_until());
    }
    if (seen) places.push_back(s.start.until(proofs_.seen()) / s.h - 1);
    for (const std::size_t j : looked_into) places.push_back((cheb::nodes[j] + cheb::nodes[j + 1]) / 2);
    add_turns(s, places);
    for (const double x : places) {
        const double t = s.time(x);
        if (t < looked) continue;
        mechanics_.loads_of_time(t, Side::at, room_.load);
        for (std::size_t i = 0; i < loads.size(); ++i) {
            if (!mechanics_.loads()[i].changes_in_time()) continue;
            const double size = size_at(i), lost = lost_in_time(loads[i], std::fabs(s.end), s.h, size);
            const double noise = noise_.floor().noise[mechanics_.system().joints[i].first()];
            const double allowed = (tolerance_ + 4 * rounding) * size + noise + lost + smallest;
            if (std::fabs(room_.load[i] - cheb::value(loads[i], x)) <= clearly * allowed) continue;
            proofs_.note_deviation(t);
            return false;
        }
        if (!mechanics_.nonlinear()) continue;
        for (std::size_t joint = 0; joint < belts.size(); ++joint) belts[joint] = mechanics_.belt(joint, t, Side::at);
        s.state(x, y);
        mechanics_.torques({t, Side::at, y}, mode, belts, room_.load, torques);
        for (std::size_t g = 0; g < frame.groups(); ++g) {
            double torque = 0, found = 0, allowed = 0;
            for (std::size_t i = 0; i < n_; ++i) {
                const double I = mechanics_.system().bodies[i].inertia;
                for (const auto& [group, by] : frame.bodies[i]) {
                    if (group != g) continue;
                    torque += by * torques[i];
                    found += by * I * cheb::value(accelerations[i], x);
                    allowed += std::fabs(by) * I * allowed_[i];
                }
            }
            if (!(std::fabs(torque - found) <= clearly * allowed)) return false;
        }
    }
    return true;
}

std::optional<double> Flow::found_break(const Segment& s) const {
    if (!(unresolved_ > gross)) return {};
    std::vector<double> loads, begin;
    for (const Nodes& each : s.y) begin.push_back(each[0]);
    std::optional<double> first;
    const auto look = [&](const Nodes& values, double size, const auto& at) {
        if (!(cheb::tail(cheb::fit(values)) > gross * 1e-13 * size)) return;
        const auto found = find_break(s.times, values, at);
        if (!found || !(*found <= s.end) || s.start.until(*found) < 1e-6 * s.h) return;
        if (!first || *found < *first) first = *found;
    };
    // Functions of the motion are evaluated at one fixed state, so that only jumps in time count.
    const auto of_motion = [&](const Signal& signal, double t, Side side) {
        return signal.samples_the_motion() ? signal.of_motion({t, side, begin}) : 0;
    };
    for (std::size_t i = 0; i < mechanics_.joints(); ++i) {
        const Signal& load = mechanics_.loads()[i];
        if (!load.has_script()) continue;
        Nodes values = s.loads[i];
        for (std::size_t j = 0; j < node_count; ++j) values[j] += of_motion(load, s.times[j], s.side(j));
        look(values, size_at(i), [&](double t) {
            mechanics_.loads_of_time(t, Side::at, loads);
            return loads[i] + of_motion(load, t, Side::at);
        });
    }
    mechanics_.for_each_signal([&](const Signal& signal) {
        const auto& of_bodies = mechanics_.loads();
        const bool looked =
            std::any_of(of_bodies.begin(), of_bodies.end(), [&](const Signal& load) { return &load == &signal; });
        if (looked || !signal.has_script() || (signal.depends_on_motion() && !signal.samples_the_motion())) return;
        const auto value = [&](double t, Side side) {
            return signal.of_time({t, side, {}}) + of_motion(signal, t, side);
        };
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = value(s.times[j], s.side(j));
        look(values, greatest(values), [&](double t) { return value(t, Side::at); });
    });
    std::vector<double> rates(m_);
    for (std::size_t k = 0; k < mechanics_.states_of_user(); ++k) {
        const auto rate = [&](double t, Side side) {
            mechanics_.rates({t, side, begin}, rates.data());
            return rates[k];
        };
        Nodes values{};
        for (std::size_t j = 0; j < node_count; ++j) values[j] = rate(s.times[j], s.side(j));
        look(values, greatest(values), [&](double t) { return rate(t, Side::at); });
    }
    return first;
}

bool Flow::belt_jumps(const Segment& s, std::size_t joint, double t) const {
    if (!mechanics_.has_belt(joint)) return false;
    constexpr double clearly = 1e-6;
    const double before = mechanics_.belt(joint, towards(t, Side::before), Side::at);
    const double jump = std::fabs(mechanics_.belt(joint, towards(t, Side::after), Side::at) - before);
    return jump > clearly * std::max(fastest_.belts[joint], greatest(s.belts[joint]));
}

std::optional<double> Flow::jump_of_belt(const Segment& s, std::size_t joint) const {
    if (!mechanics_.has_belt(joint)) return {};
    constexpr double clearly = 1e-6, near = 1e-3;
    const Nodes& belts = s.belts[joint];
    const double seen = clearly * std::max(fastest_.belts[joint], greatest(belts));
    const auto [least, most] = std::minmax_element(belts.begin(), belts.end());
    const double change = *most - *least;
    std::size_t first = 1;  // index of the greatest difference
    const auto difference = [&](std::size_t j) { return std::fabs(belts[j] - belts[j - 1]); };
    for (std::size_t j = 2; j < node_count; ++j) {
        if (difference(j) > 2 * difference(first)) first = j;
    }
    if (!(change > seen) || !(difference(first) > change / 4)) return {};
    const auto belt = [&](double t) { return mechanics_.belt(joint, t, Side::at); };
    const std::size_t from = std::max<std::size_t>(first, 2) - 2;
    const auto found = find_break(std::span(s.times).subspan(from, 3), std::span(belts).subspan(from, 3), belt);
    if (!found || !(*found > s.start.hi)) return {};
    // A jump caused by noise is no greater than the neighbouring differences.
    const double right_before = std::min(std::nextafter(*found, -model::never), *found - nearest_jump * s.h);
    const double before = belt(std::max(right_before, s.start.hi)), after = belt(*found);
    const double jump = std::fabs(after - before);
    if (!(jump > seen)) return {};
    for (const double part : {0.25, 0.5, 1.0}) {
        const double by = part * near * s.h;
        const double off_before = std::fabs(belt(std::max(*found - by, s.start.hi)) - before);
        const double off_after = std::fabs(belt(std::min(*found + by, s.end)) - after);
        if (!(std::max(off_before, off_after) < jump / 4)) return {};
    }
    return found;
}

void Flow::stand_still(Segment& s, const std::vector<double>& y) const {
    make_room(s);
    s.proven = true;
    for (std::size_t k = 0; k < s.y.size(); ++k) s.y[k].fill(y[k]), s.series[k] = {};
    for (auto of : {&Segment::moved, &Segment::driven, &Segment::belts, &Segment::belt_rates, &Segment::holding}) {
        for (Nodes& values : s.*of) values.fill(0);
    }
    for (Series& held : s.holding_series) held = {};
}

void Flow::pass_over(Segment& s) const {
    s.proven = true;
    for (std::size_t k = 0; k < s.y.size(); ++k) {
        Nodes change{};
        const double rate = k < n_ ? s.y[n_ + k][0] : s.f[k][0];
        for (std::size_t j = 1; j < node_count; ++j) {
            change[j] = s.h * (1 + cheb::nodes[j]) * (std::isfinite(rate) ? rate : 0);
            s.y[k][j] = s.y[k][0] + change[j];
        }
        s.series[k] = cheb::fit(change);
        if (k < n_) s.moved[k] = change;
        s.f[k].fill(s.f[k][0]);
    }
    for (auto of : {&Segment::torques, &Segment::driven, &Segment::loads}) {
        for (Nodes& values : s.*of) values.fill(values[0]);
    }
    for (std::size_t joint = 0; joint < s.holding.size(); ++joint) {
        s.holding[joint].fill(s.holding[joint][0]);
        s.holding_series[joint] = cheb::fit(s.holding[joint]);
    }
}

}  // namespace dinal::motion::engine
